#!/usr/bin/env bash
# thesis_figures.sh PELLUCID FOLDER [MODEL.glb OPTION...]: figures of Whelan 2009 in FOLDER, thesis.png and angles.png. The ear of the
# procedural scene, or a model with options of `pellucid capture`; figures 4.5 and 4.10 need a model.
set -euo pipefail
pellucid=$1 folder=$2
shift 2
source=("$@")
if ((${#source[@]} == 0)); then source=(--procedural ear); fi
size=256x256
mkdir -p "$folder"

images=() labels=() exposures=()

# capture NAME OPTION...
capture() {
  "$pellucid" capture "${source[@]}" --size "$size" "${@:2}" -o "$folder/$1.exr" >"$folder/$1.log" 2>&1 || { cat "$folder/$1.log" >&2; exit 1; }
}

declare -A replayed # images by capture and options: figures share pictures

# picture LABEL CAPTURE EXPOSURE OPTION...: one picture of the sheet, replayed as the thesis does
picture() {
  local key="$2 ${*:4}"
  if [[ -z ${replayed[$key]:-} ]]; then
    replayed[$key]="$folder/picture.${#images[@]}.exr"
    "$pellucid" replay "$folder/$2.exr" --mode thesis --repeat 0 "${@:4}" -o "${replayed[$key]}" >/dev/null
  fi
  images+=("${replayed[$key]}") labels+=("$1") exposures+=("$3")
}

# Exposures: 20 mm of thickness are white, and all light is as it is.
camera=(--set thickness=camera)
capture scene
picture "4.1 without" scene 1 --set features=diffusion
picture "4.1 with forward scattering" scene 1 "${camera[@]}"
picture "4.3 thickness" scene .05 "${camera[@]}" --debug thickness
picture "4.3 transmittance" scene 1 "${camera[@]}" --debug transmittance
picture "4.3 combined" scene 1 "${camera[@]}"
if [[ ${source[0]} != --* ]]; then
  capture farthest --back farthest
  picture "4.5 farthest: thickness" farthest .05 "${camera[@]}" --debug thickness
  picture "4.5 farthest back face" farthest 1 "${camera[@]}"
  picture "4.5 nearest back face" scene 1 "${camera[@]}"
fi
capture unshadowed --shadow-size 0
picture "4.6 without shadow map" unshadowed 1 "${camera[@]}"
picture "4.6 with shadow map" scene 1 "${camera[@]}"
picture "4.9 equal in R, G, B" scene 1 "${camera[@]}" --set filter=.373,.373,.373
picture "4.9 .55 .29 .28" scene 1 "${camera[@]}" --set filter=.55,.29,.28
if [[ ${source[0]} != --* ]]; then
  capture simplified --simplify .05
  picture "4.10 full model" scene 1 "${camera[@]}"
  picture "4.10 a twentieth of the triangles" simplified 1 "${camera[@]}"
fi
picture "5.2 full light" scene 1 "${camera[@]}"
picture "5.2 a quarter of it" scene 1 "${camera[@]}" --set filter=.25,.25,.25
"$pellucid" truth "${source[@]}" --size "$size" --seconds 20 --overwrite -o "$folder/truth.exr" >/dev/null 2>&1
picture "5.3 thesis" scene 1 "${camera[@]}"
images+=("$folder/physical.exr") labels+=("5.3 Pellucid") exposures+=(1)
"$pellucid" replay "$folder/scene.exr" --repeat 0 --set gather=16 -o "$folder/physical.exr" >/dev/null
images+=("$folder/truth.exr@truth") labels+=("5.3 path traced, 20 s") exposures+=(1)

IFS=,
"$pellucid" sheet "${images[@]}" --columns 5 --exposure "${exposures[*]}" "${labels[@]/#/--label=}" -o "$folder/thesis.png"
"$pellucid" angles -o "$folder/angles.png"
