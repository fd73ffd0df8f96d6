#!/usr/bin/env bash
# gallery.sh PELLUCID WORK PICTURES PAGE [MODELS]: scenes of all kinds before, after and path traced. WORK keeps captures, to which a
# second run adds samples; PICTURES gets a PNG of each scene, and PAGE is the Markdown page that shows them. MODELS: folder of head_views.glb
# of the head scan, which stands in for the procedural head and ear. SECONDS_EACH: of path tracing, default 30.
set -euo pipefail
pellucid=$1 work=$2 pictures=$3 page=$4 models=${5:-}
seconds=${SECONDS_EACH:-30} size=${SIZE:-256x192}
mkdir -p "$work" "$pictures"

wax='{"subsurface_color": [0.8, 0.65, 0.4], "subsurface_radius": 1, "subsurface_radius_scale": [1, 1, 1]}'
leaf='{"subsurface_color": [0.2, 0.4, 0.05], "subsurface_radius": 0.06, "subsurface_radius_scale": [1, 1, 1]}'
credit= device=
head=(--procedural head --set view=1) ear=(--procedural ear) sky=(--procedural ear --set backLight=0 --set frontLight=0)
if [[ -n $models ]]; then
  scan=("$models/head_views.glb" --unit 0.052 --material '*=skin1' --shadow-size 2048)
  head=("${scan[@]}" --camera auto --view 0.35,0.05,1 --fov 19 --light directional:0.6,-0.4,-0.7:2 --light directional:0.5,-0.2,0.85:2)
  ear=("${scan[@]}" --camera ear --light directional:0.06,-0.25,1:5 --light directional:0.8,-0.3,-0.6:0.5)
  credit=' The picture of the README is the ear at 420x420 pixels. Model of head and ear: "Infinite, 3D Head Scan" by Lee Perry-Smith, [CC BY 3.0](https://creativecommons.org/licenses/by/3.0/).'
fi

body=$work/body.md
: >"$body"

# scene NAME TITLE TEXT REPLAY_OPTION... -- CAPTURE_OPTION...
scene() {
  local name=$1 title=$2 text=$3 replay=() file="$work/$1"
  shift 3
  while [[ $1 != -- ]]; do replay+=("$1"); shift; done
  shift
  echo "$title"
  "$pellucid" truth "$@" --size "$size" --seconds "$seconds" --overwrite -o "$file.exr" >"$file.log" 2>&1 || { cat "$file.log" >&2; exit 1; }
  "$pellucid" replay "$file.exr" --repeat 0 --set features=none -o "$file.before.exr" >/dev/null
  device=$("$pellucid" replay "$file.exr" --repeat 0 "${replay[@]}" -o "$file.after.exr" | sed -n 1p)
  "$pellucid" sheet "$file.before.exr" "$file.after.exr" "$file.exr@truth" --columns 3 -o "$pictures/$name.png" >/dev/null
  {
    printf '## %s\n\n%s Error: %s.\n\n![%s: before, after, path traced](%s/%s.png)\n\n' "$title" "$text" "$(error "$file")" "$title" \
      "$(realpath --relative-to "$(dirname "$page")" "$pictures")" "$name"
    printf '    pellucid truth'
    local word
    for word in "$@"; do
      word=${word/#$models\//}
      if [[ $word == *[\ \*\{]* ]]; then printf " '%s'" "$word"; else printf ' %s' "$word"; fi
    done
    printf ' --size %s --seconds %s -o %s.exr\n' "$size" "$seconds" "$name"
    printf '    pellucid replay %s.exr' "$name"
    if ((${#replay[@]})); then printf ' %s' "${replay[@]}"; fi
    printf ' -o %s.after.exr\n\n' "$name"
  } >>"$body"
}

# error FILE: relative RMSE of red, green and blue
error() { "$pellucid" compare "$1.after.exr" "$1.exr" --box 4 | awk '$1 ~ /^[RGB]$/ { printf "%s%.3f", n++ ? " " : "", $2 }'; }

scene head Head "A key and a rim light. Light comes through ears and nose, and shadows have red edges." -- "${head[@]}"
scene ear Ear "A strong light behind the ear, a weak one before." -- "${ear[@]}"
scene shell "Hollow shell" "A ball of skin with a wall of 2 mm, lit from behind. The result is wrong here: the rim is too bright, and the light that crosses the hollow
is missing." -- --procedural hollow_sphere --material '*=skin2' --set extent=22
scene marble Marble "A ring of marble, 5 mm thick, lit from behind." -- --procedural torus --material '*=marble' --set tube=0.2
scene wax Wax "A carved sheet of wax before a lamp, described by OpenPBR's color and radius." -- --procedural noise --material "*=$wax"
scene milk Milk "Drops of whole milk." -- --procedural spheres --material '*=whole_milk'
scene leaf Leaves "Blades of grass, 0.4 mm thick." -- --procedural blades --material "*=$leaf"
scene sky "Sky only" "No light but a sky. Its light on visible faces spreads; \`--set ambient=1\` would let it through thin parts, too." -- "${sky[@]}" --environment gradient:0.6,0.8,1.2:0.4,0.3,0.2
scene lights "Many lights" "Twelve lights of all hues around a head, each with a shadow map." -- --procedural head --set view=1 --set keyLight=0 --set rimLight=0 \
  --set lights=12

cat - "$body" >"$page" <<EOF
# Gallery

This page shows what Pellucid does to scenes of all kinds, and how near the result comes to path tracing. \`./run gallery\` makes the page and its
pictures from procedural scenes, \`./run gallery MODELS\` with a head scan in the place of the procedural head and ear.

Each picture has three panels under one exposure: without Pellucid | with Pellucid | path traced. Path tracing had $seconds seconds for
each picture, so its panels are noisy. The number is the relative RMSE of red, green and blue against path tracing, over averages of 4x4 pixels, noise
included. Device: $device; commit $(git describe --always --dirty --abbrev=12).$credit

EOF
