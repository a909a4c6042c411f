#!/usr/bin/env bash
# names_of_files.sh SOURCE PROGRAMS FOLDER
# ./run, called from elsewhere: names of files that are read and written are from where the user stands.
# A copy of `run` is called, which finds the built programs and has nothing to prepare.
set -u
source=$1 programs=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder/repository/cmake" "$folder/repository/build/release" "$folder/user/some/cases" || exit 1
cp "$source/run" "$folder/repository/run"
ln -s "$source/miniapps" "$source/meshes" "$source/problems" "$folder/repository/"
ln -s "$programs" "$folder/repository/build/release/miniapps"
cat >"$folder/repository/cmake/setup.sh" <<'SETUP'
flavour=${flavour:-serial} build=build/release deps=build/deps
prepare() { :; }
die() { echo "cattaneo: $*" >&2; exit 1; }
SETUP
cd "$folder/user" || exit 1
run=../repository/run
failed=0
fault() { echo "FAILED: $*"; failed=1; }
there() { for file in "$@"; do [ -s "$file" ] || fault "$file is not where the user stands"; done; }

# A case file of a study, beside nothing of its name in the repository; the file itself is named from below it.
printf '{"nodes": 21, "friction": 0.3}\n' >some/cases/punch.json
$run square_punch --case some/cases/punch.json --json out.json --csv table --save some/problem.json --html page.html >log 2>&1 ||
   fault "square_punch --case ended with $?: $(cat log)"
there out.json table_*.csv some/problem.json page.html
grep -q '"contact_nodes": *21' out.json || fault "the case file of the user was not the one that was read"
# What was written is read again, by another program and from another folder.
(cd some && ../$run march --reduced problem.json --history "P=0; P=1" --json again.json >log 2>&1 || { echo FAILED; cat log; })
there some/again.json
# A figure is drawn where the user stands too, where there is a Python that draws.
if python3 -c 'import matplotlib' 2>/dev/null; then
   $run square_punch -nodes 21 --plot figure.png >log 2>&1 || fault "--plot ended with $?: $(cat log)"
   there figure*.png
fi
# A name that is only in the repository is none where the user stands.
$run march --reduced problems/hertz.json --history "P=0; P=1" >log 2>&1 && fault "a file of the repository was read that was not named from here"
# Nothing is left in the repository.
left=$(cd ../repository && find . -newer run -type f ! -path './cmake/*' ! -path './miniapps/*')
[ -z "$left" ] || fault "left in the repository: $left"
# From the repository names are as ever.
(cd ../repository && ./run march --reduced problems/hertz.json --history "P=0; P=1" --json ../user/hertz.json >../user/log 2>&1) || fault "from the repository: $(cat log)"
there hertz.json
exit $failed
