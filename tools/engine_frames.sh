#!/usr/bin/env bash
# engine_frames.sh PELLUCID MODELS FOLDER [NAME...]: frames as engines make them, of MODELS/head_views.glb and MODELS/crowd.glb, each
# with path-traced truth, FOLDER/NAME.exr, and after its light turned by half a degree, FOLDER/NAME.turned.exr. FOLDER/NAME.png shows
# the result beside the truth. NAME: of these frames; default: all. SPP: samples a pixel of the truth, default 128,
# which a second run adds to.
set -euo pipefail
pellucid=$1 models=$2 folder=$3
wanted=("${@:4}") spp=${SPP:-128}
known='portrait_grazing closeup_d16 portrait_d24 closeup_cascades portrait_filtered portrait_jittered crowd_d16 ear_offset'
for name in "${wanted[@]}"; do
  [[ " $known " == *" $name "* ]] || { echo "engine_frames.sh: there is no frame \"$name\" but $known" >&2; exit 2; }
done
mkdir -p "$folder"

# frame NAME MODEL CAMERA SIZE CAPTURE_OPTION...
frame() {
  local name=$1 model=(--unit 0.052 --material '*=skin1') file=$folder/$1
  if ((${#wanted[@]})) && [[ " ${wanted[*]} " != *" $name "* ]]; then return; fi
  echo "$name"
  "$pellucid" capture "$models/$2" "${model[@]}" --camera "$3" --size "$4" "${light[@]}" "${@:5}" --light-turntable 720 --frames 1-2 \
    -o "$file.frame#.exr" >"$file.log" 2>&1 || { cat "$file.log" >&2; exit 1; }
  "$pellucid" truth "$models/$2" "${model[@]}" --like "$file.frame1.exr" --spp "$spp" -o "$file.exr" |
    tee -a "$file.log" | sed -n 's/^noise of 4x4/  &/p'
  mv "$file.frame2.exr" "$file.turned.exr"
  rm "$file.frame1.exr"
  "$pellucid" replay "$file.exr" --repeat 0 -o "$file.out.exr" >>"$file.log"
  /usr/bin/python3 "$(dirname "$0")/sheet.py" "$file.out.exr" "$file.exr@truth" -o "$file.png"
}

# Grazes brow, nose and chest.
light=(--light directional:0.6,-0.75,-0.45:3)
frame portrait_grazing head_views.glb portrait 640x360 --shadow-size 2048
frame closeup_d16 head_views.glb closeup 480x270 --shadow-size 1024 --shadow-bits 16 --shadow-depth-bias 4,3
frame portrait_d24 head_views.glb portrait 640x360 --shadow-size 2048 --shadow-bits 24 --shadow-depth-bias 1.25,1.75 --shadow-filter 1
frame closeup_cascades head_views.glb closeup 480x270 --shadow-size 1024 --shadow-cascades 4 --shadow-bits 16 \
  --shadow-depth-bias 4,3 --shadow-filter 3
frame portrait_filtered head_views.glb portrait 640x360 --shadow-size 2048 --shadow-depth-bias 1.25,4 --shadow-filter 5
frame portrait_jittered head_views.glb portrait 640x360 --shadow-size 2048 --shadow-bits 16 --shadow-depth-bias 4,3 --shadow-filter 1 \
  --jitter 0.37,-0.21
frame crowd_d16 crowd.glb crowd 960x540 --shadow-size 2048 --shadow-bits 16 --shadow-depth-bias 4,3 --shadow-filter 3
# From behind the ear, and weakly from the front. The biases are 2.5 texels, as Unity has them.
light=(--light directional:0.06,-0.25,1:5 --light directional:0.8,-0.3,-0.6:0.5)
frame ear_offset head_views.glb ear 480x270 --shadow-size 2048 --shadow-bits 16 --shadow-depth-bias 80,0 --shadow-normal-offset 2.5 \
  --shadow-filter 1
