#!/bin/sh
# compilers.sh SOURCE FOLDER TEST_PIPELINE [CMAKE-ARGUMENT...]: builds test_pipeline by another compiler (clang++ where no
# argument says otherwise) into FOLDER and compares its digests of results with those of the program TEST_PIPELINE.
set -eu
source=$1 folder=$2 ours=$3
shift 3
[ $# -gt 0 ] || set -- -DCMAKE_CXX_COMPILER=clang++
mkdir -p "$folder"
cmake -S "$source" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADSEG_BUILD_TESTS=ON "$@" >"$folder/configure.log"
cmake --build "$folder" --target test_pipeline >"$folder/build.log" || { cat "$folder/build.log"; exit 1; }
rm -f "$folder/ours.txt" "$folder/theirs.txt"
QUADSEG_DIGESTS="$folder/ours.txt" "$ours" --gtest_brief=1 --gtest_filter='Digests.*'
QUADSEG_DIGESTS="$folder/theirs.txt" "$folder/tests/test_pipeline" --gtest_brief=1 --gtest_filter='Digests.*'
diff "$folder/ours.txt" "$folder/theirs.txt"
echo "$(wc -l <"$folder/ours.txt") results are the same to the byte"
