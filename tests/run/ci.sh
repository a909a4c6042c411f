#!/usr/bin/env bash
# ci.sh SOURCE FOLDER
# .ci/run with commands that only write down that they were called: its parts in their order with their times, the
# rest of the rooms that a commit touches, what is left out when the time is over, and how a failure ends it.
set -u
source=$1 folder=$2
command -v git >/dev/null || { echo "skipped: git is not here"; exit 77; }
rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1
failed=0
fault() { echo "FAILED: $*"; sed 's/^/   | /' log; failed=1; }
says() { grep -qE "$1" log || fault "no line '$1'"; }

mkdir -p .ci cmake tests/core plugin/cattaneo/wear plugin/cattaneo/friction
cp "$source/.ci/run" .ci/
cp "$source/tests/rooms.py" tests/
printf '%s\n' 'core/wear_test.cpp everyday wear' 'core/law_test.cpp rest friction' >tests/rooms.txt
echo 'install_packages() { :; }' >cmake/setup.sh
printf '#!/bin/sh\necho "test $*" >>called\ncase "$*" in "$FAILS") exit 3 ;; "$LASTS") sleep 100 ;; esac\n' >test
printf '#!/bin/sh\necho "run $*" >>called\n' >run
printf '#!/bin/sh\nexit 0\n' >clang-format
chmod +x test run clang-format
touch plugin/cattaneo/wear/archard.cpp plugin/cattaneo/friction/march.cpp tests/core/wear_test.cpp tests/core/law_test.cpp
git init -q . && git config user.email nobody@example.org && git config user.name nobody && git add -A && git commit -qm one
echo 1 >plugin/cattaneo/wear/archard.cpp
echo 1 >tests/core/law_test.cpp
git commit -qam two
export PATH=$PWD:$PATH FAILS=none LASTS=none

.ci/run >log 2>&1 || fault "ended with $?"
printf 'test \ntest --mpi -L mpi\ntest --sanitize\nrun docs\ntest --room friction --rest\ntest --room wear --rest\n' >wanted
diff wanted called >>log || fault "other commands were called than wanted"
for name in formatting 'everyday tests' ranks sanitizers documentation 'the rest of friction' 'the rest of wear'; do
   says "^ +[0-9]+ min [0-9]{2} s  $name\$"
done
says '^ +[0-9]+ min [0-9]{2} s  in all$'

CATTANEO_CI_MINUTES=0 .ci/run HEAD~1..HEAD >log 2>&1 || fault "ended with $? when there was no time left"
says 'left out \(0 minutes are over\): friction wear$'

LASTS='--room friction --rest' FAILS='--room wear --rest' CATTANEO_CI_MINUTES=0.5 .ci/run >log 2>&1 || fault "ended with $? when a room did not end"
says 'the rest of friction, not ended$'
says 'left out .*: friction wear$'

FAILS='--sanitize' .ci/run >log 2>&1 && fault "a failure of the sanitizers was passed over"
says 'sanitizers, failed$'
grep -q documentation log && fault "it went on after a failure"
FAILS='--room wear --rest' .ci/run >log 2>&1 && fault "a failure of a room was passed over"
says 'the rest of wear, failed$'
exit $failed
