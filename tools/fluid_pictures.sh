#!/bin/sh
# Pictures of everything that is wet, smokes or fogs, into a folder: a story in the still pelvis (jet, film, pool, ripples,
# dilution, smoke), a lens that is fogged and wiped in the bleeding scene, and the bleeding-control demonstration.
#
#   tools/fluid_pictures.sh FOLDER [WIDTH HEIGHT]          some minutes; the build must be configured with TROCAR_BENCH
set -e
out=${1:?usage: tools/fluid_pictures.sh FOLDER [WIDTH HEIGHT]}
width=${2:-640} height=${3:-480}
cd "$(dirname "$0")/.."
build=build/release
ninja -C $build trocar fluids_in_view lens_in_view
mkdir -p "$out/story" "$out/lens"
$build/bench/fluids/fluids_in_view "$out/story" "$width" "$height"
$build/bench/fluids/lens_in_view "$out/lens" "$width" "$height"
$build/trocar train gynaecology/bleeding-control --input demo --headless --shots "$out/control" --size "${width}x$height"
