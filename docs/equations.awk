# Doxygen's filter of headers: equations in block comments stand 7 columns in; Markdown wants more to
# show them as they are.
{
   match($0, /^ */)
   if ($0 ~ /^ *\/\*\*/) { inside = 1; start = RLENGTH }
   else if (inside && $0 ~ /[^ ]/ && RLENGTH >= start + 7) { $0 = "       " $0 }
   if (inside && $0 ~ /\*\//) { inside = 0 }
   print
}
