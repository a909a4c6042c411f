# Tiers and rooms of tests. rooms.txt has a line for every file of tests: its tier (everyday: ./test, sample: a
# part of it there; rest: ./test --all and ./test --room) and the rooms of plugin/cattaneo that it looks at.

# Helpers that know MFEM.
set(helpers_with_mfem "/support/(axisymmetric_integrator|cylinders|elastic_support|meshes_of_lines|punch_problem|two_blocks)\\.cpp$")

# With CMAKE_UNITY_BUILD so many bytes of tests are compiled as one file: more take less time, and more memory.
# Those of these kinds have MFEM, which takes half of the memory that a job may have.
set(bytes_of_tests 30000)
set(bytes_of_unit_tests 20000)

set(rooms_of_tests ${CMAKE_CURRENT_LIST_DIR}/rooms.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${rooms_of_tests})
file(STRINGS ${rooms_of_tests} lines_of_tests REGEX "^[^#]")

# Sets `tier` to that of a file of tests (core/march_test.cpp): everyday (a sample is), or rest. A new file
# needs its line.
function(tier_of_tests file tier)
   set(lines ${lines_of_tests})
   list(FILTER lines INCLUDE REGEX "^${file} ")
   if(NOT lines MATCHES "^[^ ]+ +(everyday|sample|rest)( |$)")
      message(FATAL_ERROR "tests/${file} has no line in tests/rooms.txt, which says its tier "
         "(everyday, sample or rest) and its rooms: add '${file}  everyday  ROOM…'")
   endif()
   string(REPLACE "sample" "everyday" found ${CMAKE_MATCH_1})
   set(${tier} ${found} PARENT_SCOPE)
endfunction()

# Sets `files` to the sources of a kind of tests (a folder here) that are in a tier.
function(files_of_tests kind tier files)
   file(GLOB all CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${kind}/*.cpp)
   list(FILTER all EXCLUDE REGEX "/stress/campaign.cpp$") # a program of its own
   set(found "")
   foreach(file IN LISTS all)
      get_filename_component(name ${file} NAME)
      tier_of_tests(${kind}/${name} its_tier)
      if(its_tier STREQUAL tier)
         list(APPEND found ${file})
      endif()
   endforeach()
   set(${files} ${found} PARENT_SCOPE)
endfunction()

# Sets `filter` to the single tests in these files that rooms.txt leaves to the rest, as GoogleTest names them.
function(single_tests_of_the_rest filter)
   set(found "")
   set(lines ${lines_of_tests})
   list(FILTER lines INCLUDE REGEX "^[A-Z][A-Za-z]+\\.[A-Za-z]+ +rest ")
   foreach(file IN LISTS ARGN)
      file(STRINGS ${file} tests REGEX "^TEST(_F)?\\(")
      foreach(line IN LISTS lines)
         string(REGEX MATCH "^([A-Za-z]+)\\.([A-Za-z]+)" name ${line})
         if(tests MATCHES "\\(${CMAKE_MATCH_1}, ${CMAKE_MATCH_2}\\)")
            list(APPEND found ${name})
         endif()
      endforeach()
   endforeach()
   list(JOIN found ":" found)
   set(${filter} "${found}" PARENT_SCOPE)
endfunction()

# Tests of a program that only `ctest -C All` knows.
function(discover_rest program kind)
   get_property(before DIRECTORY PROPERTY TEST_INCLUDE_FILES)
   gtest_discover_tests(${program} ${ARGN} PROPERTIES LABELS ${kind} DISCOVERY_TIMEOUT 60)
   get_property(listed DIRECTORY PROPERTY TEST_INCLUDE_FILES)
   list(REMOVE_ITEM listed ${before})
   set(guard ${CMAKE_CURRENT_BINARY_DIR}/${program}_of_all.cmake)
   file(WRITE ${guard}.new "if(CTEST_CONFIGURATION_TYPE STREQUAL \"All\")\n   include([==[${listed}]==])\nendif()\n")
   configure_file(${guard}.new ${guard} COPYONLY)
   set_property(DIRECTORY PROPERTY TEST_INCLUDE_FILES ${before} ${guard})
endfunction()
