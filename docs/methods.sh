#!/bin/sh
# Draws the survey's scenes by every method and joins the pictures to docs/methods.png, a row a scene.
# usage: sh docs/methods.sh, after `cargo build --release`; needs ImageMagick
set -eu
cd "$(dirname "$0")/.."
survey=../shared/data/survey
pliant=${CARGO_TARGET_DIR:-target}/release/pliant
if [ ! -d $survey ]; then
    echo "The survey's scenes are not part of the project: $survey is missing, with NAME.off and NAME.edit.json." >&2
    exit 1
fi
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
for scene in plane cylinder bar cactus; do
    for method in '"bilaplacian"' '"arap"' '"arap","energy":"smooth"' '"primo"'; do
        edit=$folder/edit.json
        sed "s/\"name\":\"bilaplacian\"/\"name\":$method/" "$survey/$scene.edit.json" >"$edit"
        picture="$folder/$scene-$(printf %s "$method" | tr -dc a-z).png"
        "$pliant" render "$survey/$scene.off" --edit "$edit" --output "$picture" --size 560x560 --up z --transparent
    done
    # A row is cut to what stands in it, the same in all its pictures, so that they compare.
    part=$(convert "$folder/$scene"-*.png -background none -layers flatten -format '%@' info:)
    set -- "$folder/$scene-bilaplacian.png" "$folder/$scene-arap.png" "$folder/$scene-arapenergysmooth.png" \
        "$folder/$scene-primo.png"
    montage "$@" -crop "$part" +repage -tile 4x1 -background '#f4f4f1' -geometry '260x+14+14>' "$folder/row-$scene.png"
done
convert "$folder/row-plane.png" "$folder/row-cylinder.png" "$folder/row-bar.png" "$folder/row-cactus.png" \
    -background '#f4f4f1' -gravity center -append -strip -depth 8 -define png:compression-level=9 docs/methods.png
