#!/bin/sh
# Installs headers and libraries, builds packaging/example with find_package(stiffscope), and runs it on a sample.
# example_test.sh CMAKE BUILD_DIR SOURCE_DIR COMPILER WORK_DIR [FLAGS]: flags of the compiler that the libraries need, as
# those of the sanitizers
set -eu
cmake=$1 build=$2 source=$3 compiler=$4 work=$5 flags=${6:-}
rm -rf "$work"
"$cmake" --install "$build" --component dev --prefix "$work/prefix" >/dev/null
"$cmake" -G Ninja -S "$source/packaging/example" -B "$work/build" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="$flags" >/dev/null
"$cmake" --build "$work/build" >/dev/null
"$work/build/stiffness_of" "$source/samples/active" > "$work/stiffnesses"
cat "$work/stiffnesses"
grep -q '^k1 not identifiable' "$work/stiffnesses"
test "$(grep -c '^k[2-6] [0-9.e+]* Nm/rad$' "$work/stiffnesses")" = 5
rm -rf "$work"
