#include "frame.h"

#include <algorithm>

#include "defaults.h"
#include "entry_points.h"
#include "gather.h"
#include "validate.h"

namespace pellucid {
namespace {

void addView(FrameFacts& f) {
  const PellucidFrame& frame = f.frame;
  f.rect = renderRect(frame);
  f.wide = frame.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT;
  f.colorFormat = f.wide ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT;
  for (const ImageField& image : kImageFields)
    if (given(frame.*image.field)) f.images |= 1u << image.resource;
  f.inPlace = given(frame.output) && frame.output.view == frame.irradiance.view;
  f.clipFromView = toMatrix(frame.clipFromView);
  f.viewFromWorld = toMatrix(frame.viewFromWorld);
  readDepthRange(f.clipFromView, &f.depthRange);
  f.view = ViewBounds(f);
  f.pyramid = Pyramid(frame.imageExtent, f.rect);
}

const char* whyNotGathered(const FrameFacts& f) {
  if (f.frame.thicknessSource == PELLUCID_THICKNESS_CAMERA) return "thickness comes from the camera";
  if (f.thesis.materialMarkBit != 0) return "materialMarkBit is of one thickness a pixel";
  if (f.thesis.angleModel != PELLUCID_ANGLE_NORMAL || f.thesis.constantViewDirection != 0 ||
      f.thesis.minimumDot != 0 || f.thesis.maximumThickness > 0)
    return "angleModel, constantViewDirection, minimumDot and maximumThickness are of one thickness a pixel";
  if (!f.solids) return "every material is thin-walled";
  for (uint32_t i = 0; i < f.frame.materialCount; ++i)
    if (!canBeGathered(f.material(i).transmittanceModel))
      return "a material's transmittance model has no profile";
  return nullptr;
}

uint32_t gatherSpacing(const PellucidFrame& frame) {
  if (frame.gatherSpacing != 0) return frame.gatherSpacing;
  const uint64_t pixels = static_cast<uint64_t>(frame.imageExtent[0]) * frame.imageExtent[1];
  return pixels > 1u << 20 ? 4 : pixels > 1u << 19 ? 2 : 1;
}

void addMaterials(FrameFacts& f) {
  for (uint32_t i = 0; i < f.frame.materialCount; ++i) {
    const PellucidMaterial m = f.material(i);
    f.diffuses = f.diffuses || f.diffused(i).gaussianCount > 0;
    (m.thinWalled != 0 ? f.thinWalls : f.solids) = true;
  }
  f.reach = diffusionReach(f);
}

void addGather(FrameFacts& f) {
  f.whyNotGathered = whyNotGathered(f);
  if (f.frame.targetError > 0) f.missesTarget = !samplesOfTarget(f, &f.frame.gatherSamples);
  f.gatherSamples = f.whyNotGathered ? 0 : f.frame.gatherSamples;
  f.gatherSpacing = gatherSpacing(f.frame);
  f.longestEntrySide = longestEntrySide(f);
  f.gathers = (f.frame.features & PELLUCID_FEATURE_TRANSLUCENCY) != 0 && f.gatherSamples > 0 && !f.debug();
  f.shapes = f.gathers && f.diffuses && f.has(PELLUCID_RESOURCE_NORMAL);
}

void addLights(FrameFacts& f) {
  f.ambient = ambientLight(f.frame);
  // The debug view of thickness shows the chord, too.
  f.needsChord = f.frame.thicknessSource == PELLUCID_THICKNESS_CAMERA || f.ambient.intensity > 0 ||
                 f.frame.debugView == PELLUCID_DEBUG_THICKNESS ||
                 std::any_of(f.frame.lights, f.frame.lights + f.frame.lightCount,
                             [&](const PellucidLight& light) { return f.takesChord(light); });
  f.lights = LightGroups::of(f);
}

// Leaves out levels for radii that are small in pixels.
void limitLevels(FrameFacts& f) {
  while (f.reach.deviation > 0 && f.coarsestLevel > kFirstLevel + 2 &&
         f.reach.deviation <= deviationWithin(f.coarsestLevel - 2))
    f.coarsestLevel -= 2;
}

void addStages(FrameFacts& f) {
  f.blocks = Blocks(f, f.rect);
  f.stages = Stages(f);
  f.coarsestLevel = f.pyramid.coarsest;
  if (f.stages.diffusion) limitLevels(f);
  f.constants = ConstantsLayout(f);
}

// Sizes of the caller's structs, before anything else of them is read.
bool takeStructs(const PellucidFrame* frame, Findings& out, FrameFacts& f) {
  if (!canReadStruct(frame, kLeastFrame)) {
    out.fail(PELLUCID_ERROR_VERSION, "structSize", "is ", frame->structSize, "; this library reads ",
             kLeastFrame, " to ", sizeof(PellucidFrame),
             " bytes, and more if they are 0 (call pellucidInitFrame)");
    return false;
  }
  f.frame = readStruct(frame, defaultFrame());
  const PellucidThesisOptions* thesis = f.frame.thesis;
  if (thesis && !canReadStruct(thesis, kLeastThesisOptions)) {
    out.fail(PELLUCID_ERROR_VERSION, "thesis.structSize", "is ", thesis->structSize, "; this library reads ",
             kLeastThesisOptions, " to ", sizeof(PellucidThesisOptions),
             " bytes, and more if they are 0 (call pellucidInitThesisOptions)");
    return false;
  }
  f.thesis = thesis ? readStruct(thesis, defaultThesisOptions()) : defaultThesisOptions();
  return true;
}

}  // namespace

PellucidMaterial FrameFacts::material(uint32_t index) const {
  // The caller's structs lie as far apart as each is long.
  const auto* bytes = reinterpret_cast<const unsigned char*>(frame.materials);
  const size_t offset = static_cast<size_t>(index) * frame.materials->structSize;
  PellucidMaterial m =
      readStruct(reinterpret_cast<const PellucidMaterial*>(bytes + offset), PellucidMaterial{});
  if (m.thinWalled == 0) return m;
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
  for (int c = 0; c < 3; ++c) {
    std::fill_n(m.transmittance[c], 5, 0.0f);
    m.transmittance[c][0] = m.wallTransmittance[c];
  }
  return m;
}

PellucidMaterial FrameFacts::diffused(uint32_t index) const {
  PellucidMaterial m = material(index);
  if (!(frame.features & PELLUCID_FEATURE_DIFFUSION)) m.gaussianCount = 0;
  return m;
}

PellucidResult readFrame(const PellucidFrame* frame, Findings& out, FrameFacts* facts) {
  FrameFacts& f = *facts;
  if (!frame) {
    out.error("frame", "is NULL");
    return out.result();
  }
  if (!takeStructs(frame, out, f)) return out.result();
  checkFields(f, out);
  if (out.result() != PELLUCID_OK) return out.result();
  checkMaterials(f, out);
  checkShadowMaps(f, out);
  if (out.result() != PELLUCID_OK) return out.result();
  addView(f);
  addMaterials(f);
  addGather(f);
  checkLights(f, out);
  if (out.result() != PELLUCID_OK) return out.result();
  addLights(f);
  addStages(f);
  checkGroups(f, out);
  return out.result();
}

}  // namespace pellucid
