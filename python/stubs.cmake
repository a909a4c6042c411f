# Takes the "| None" off that nanobind appends to every argument.
foreach(stub IN LISTS STUBS)
   file(READ ${stub} text)
   string(REPLACE " | None" "" text "${text}")
   file(WRITE ${stub} "${text}")
endforeach()
