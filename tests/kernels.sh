#!/usr/bin/env bash
# kernels.sh BUILD   core and unit tests and the short stress suite with the kernels that OpenBLAS chooses here, and
#                    with four others by name. Prints a line for each; what failed is in BUILD/tests/kernels.
#
# Kernels that this processor cannot run, or that multiply small matrices wrong on it, are left out and named: what
# is wrong there is OpenBLAS's. With another BLAS there is nothing to choose, and the tests run once.
set -u
build=$1
programs=$build/tests
logs=$programs/kernels
kernels=$build/miniapps/blas_kernels
mkdir -p "$logs"
export OPENBLAS_NUM_THREADS=1 CATTANEO_STRESS=short
unset OPENBLAS_CORETYPE

# The kernels by name, or their own if there is none: in shares, as many side by side as there are processors.
run()
{
   local name=$1 program share shares failed
   [ "$name" = default ] || export OPENBLAS_CORETYPE=$name
   {
      for program in core_tests core_rest_tests unit_tests unit_rest_tests stress_tests; do
         [ $program = stress_tests ] && shares=2 || shares=6
         for ((share = 0; share < shares; ++share)); do echo "$program" $shares $share; done
      done
   } | programs=$programs logs=$logs name=$name xargs -P "$(nproc)" -L 1 sh -c \
      'GTEST_TOTAL_SHARDS=$1 GTEST_SHARD_INDEX=$2 "$programs/$0" --gtest_brief=1 >"$logs/$name.$0.$2.log" 2>&1'
   failed=$?
   unset OPENBLAS_CORETYPE
   grep -h '^\[  FAILED  \] .*ms)' "$logs/$name".*.log
   return $failed
}

default=$("$kernels")
failed=""
report()
{
   local start=$SECONDS
   if run "$1"; then echo "kernels $2: all tests pass ($((SECONDS - start)) s)"
   else
      echo "kernels $2: there are failures ($((SECONDS - start)) s)"
      failed="$failed $2"
   fi
}

rm -f "$logs"/*.log
report default "${default:-of a BLAS that is not OpenBLAS}${default:+ (chosen here)}"
[ -n "$default" ] || { [ -z "$failed" ]; exit; }
tried=0
for name in Prescott Nehalem Sandybridge Haswell SkylakeX; do
   [ $tried = 4 ] || [ "$name" = "$default" ] && continue
   if [ "$(OPENBLAS_CORETYPE=$name "$kernels" 2>/dev/null)" != "$name" ]; then
      echo "kernels $name: left out, OpenBLAS does not have them for this processor"
   elif ! OPENBLAS_CORETYPE=$name "$kernels" --check >/dev/null 2>&1; then
      echo "kernels $name: left out, they multiply small matrices wrong on this processor (a fault of OpenBLAS)"
   else
      tried=$((tried + 1))
      report "$name" "$name"
   fi
done
[ -z "$failed" ] || { echo "failures, in $logs:$failed"; exit 1; }
