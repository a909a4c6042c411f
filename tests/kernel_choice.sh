#!/usr/bin/env bash
# kernel_choice.sh SOURCE BUILD FOLDER   do ./run and the installed `cattaneo` choose kernels of OpenBLAS as they should?
#
# Both ask a program, blas_kernels, in whose place another one stands here: it says which kernels are better, and whether
# these multiply right.
set -u
source=$1 folder=$3
command=$2/miniapps/cattaneo
rm -rf "$folder"
mkdir -p "$folder/miniapps" "$folder/bin" "$folder/libexec/cattaneo" "$folder/share/cattaneo"
cat >"$folder/miniapps/blas_kernels" <<'FAKE'
#!/bin/sh
case $1 in
--better) echo "$BETTER" ;;
--check) [ "$RIGHT" = "$OPENBLAS_CORETYPE" ] ;;
esac
FAKE
printf '#!/bin/sh\necho "${OPENBLAS_CORETYPE-none}"\n' >"$folder/libexec/cattaneo/tell"
chmod +x "$folder/miniapps/blas_kernels" "$folder/libexec/cattaneo/tell"
cp "$folder/miniapps/blas_kernels" "$folder/libexec/cattaneo/"
cp "$command" "$folder/bin/"
chmod +x "$folder/bin/cattaneo"
cd "$source" || exit 1
. cmake/setup.sh
build=$folder
failed=0

# expect WANTED [NAME=VALUE…]: in that environment.
expect()
{
   local wanted=$1 run installed
   shift
   run=$(unset OPENBLAS_CORETYPE; [ $# = 0 ] || export "$@"; choose_kernels; echo "${OPENBLAS_CORETYPE-none}")
   installed=$(unset OPENBLAS_CORETYPE; [ $# = 0 ] || export "$@"; "$folder/bin/cattaneo" tell)
   if [ "$run" != "$wanted" ] || [ "$installed" != "$wanted" ]; then
      echo "with $*: ./run takes '$run' and cattaneo '$installed', expected '$wanted'"
      failed=1
   fi
}

expect none BETTER= RIGHT=Haswell                               # those that were chosen are good
expect Haswell BETTER=Haswell RIGHT=Haswell                     # they are far below the processor
expect none BETTER=Haswell RIGHT=none                           # the better ones multiply wrong on it
expect Prescott BETTER=Haswell RIGHT=Haswell OPENBLAS_CORETYPE=Prescott # who says which is obeyed,
expect '' BETTER=Haswell RIGHT=Haswell OPENBLAS_CORETYPE=               # also who says none
exit $failed
