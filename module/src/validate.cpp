// Every convention, checked, in a sentence a person understands.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "domains.h"
#include "material/tables.h"
#include "planner.h"

namespace pellucid {
namespace {

void checkImageSize(const PellucidFrame& f, Findings& out) {
  const uint32_t w = f.imageExtent[0], h = f.imageExtent[1];
  if (w == 0 || h == 0 || w > 65536 || h > 65536) {
    out.error("imageExtent", "is ", w, " x ", h, "; both must be 1..65536");
    return;
  }
  const uint32_t* r = f.options.renderRect;
  if (r[2] == 0 && (r[0] || r[1] || r[3]))
    out.error("options.renderRect", "has width 0 (the whole image) but x ", r[0], ", y ", r[1], ", height ",
              r[3]);
  else if (r[2] > 0 && (r[3] == 0 || r[0] >= w || r[2] > w - r[0] || r[1] >= h || r[3] > h - r[1]))
    out.error("options.renderRect", "is ", r[0], ", ", r[1], " + ", r[2], " x ", r[3], ", outside the ", w,
              " x ", h, " image");
}

// All indices must come through the mask.
void checkMaterialBits(const Inputs& inputs, Findings& out) {
  const PellucidFrame& f = inputs.frame;
  if (f.options.materialShift > 31) return;  // its domain says so
  const uint32_t below = (1u << f.options.materialShift) - 1;
  if ((f.options.materialMask & below) != 0)
    out.error("options.materialMask", "is ", f.options.materialMask, ", whose last bits materialShift ",
              f.options.materialShift, " drops");
  uint32_t indices = 0;
  while (indices < f.materialCount && indices < 255) indices = indices << 1 | 1;
  if ((indices & ~inputs.materialBits()) != 0)
    out.error("options.materialMask", "is ", f.options.materialMask, " with materialShift ",
              f.options.materialShift, ", which leave ", inputs.materialBits(), "; the indices of ",
              f.materialCount, " materials take ", indices);
}

void checkLightTables(const PellucidFrame& f, Findings& out) {
  if (f.options.lightTableCount > PELLUCID_MAX_LIGHT_TABLES) return;  // its domain says so
  if (f.options.lightTableCount > 0 && !f.options.lightTables)
    out.error("options.lightTables", "is NULL, but lightTableCount is ", f.options.lightTableCount);
  for (uint32_t i = 0; f.options.lightTables && i < f.options.lightTableCount; ++i)
    checkDomains(f.options.lightTables[i], Field("options.lightTables[", i, "]."), out);
}

}  // namespace

void checkFields(const Inputs& inputs, Findings& out) {
  const PellucidFrame& f = inputs.frame;
  constexpr uint32_t known = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  if (f.options.features & ~known) out.error("options.features", "has unknown bits: ", f.options.features);
  checkImageSize(f, out);
  checkDomains(f, "", out);
  checkDomains(inputs.thesis, "thesis.", out);
  DepthRange range;
  if (const char* wrong = readDepthRange(toMatrix(f.clipFromView), &range)) out.error("clipFromView", wrong);
  if (!isRigid(toMatrix(f.viewFromWorld))) out.error("viewFromWorld", "is not a rotation and translation");
  if (f.options.outputFormat != VK_FORMAT_R16G16B16A16_SFLOAT &&
      f.options.outputFormat != VK_FORMAT_R32G32B32A32_SFLOAT &&
      f.options.outputFormat != VK_FORMAT_B10G11R11_UFLOAT_PACK32)
    out.error("options.outputFormat", "is VkFormat ", static_cast<int>(f.options.outputFormat),
              "; use R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT or B10G11R11_UFLOAT_PACK32");

  if (f.options.gatherSpacing != 0 && f.options.gatherSpacing != 1 && f.options.gatherSpacing != 2 &&
      f.options.gatherSpacing != 4)
    out.error("options.gatherSpacing", "is ", f.options.gatherSpacing,
              "; use 1, 2 or 4, or 0 to choose by the image's size");
  const float anchored = f.options.anchor[3];
  if (anchored != 0 && anchored != 1)
    out.error("options.anchor", "has w ", anchored, "; use 1 for a point and 0 for none");
  else if (anchored == 1 && f.options.reuse != PELLUCID_REUSE_NONE && f.options.reuse != PELLUCID_REUSE_ACCUMULATE)
    out.error("options.anchor", "has w 1 with reuse ", f.options.reuse,
              "; light of an earlier frame needs cells that stay with the screen");
  if (f.options.backDepthEncoding == PELLUCID_DEPTH_DISTANCE)
    out.error("options.backDepthEncoding", "is ", f.options.backDepthEncoding, "; use DEVICE, VIEW_Z or THICKNESS");
  if (f.options.backDepthEncoding == PELLUCID_DEPTH_THICKNESS && f.options.cameraThickness == 1 && f.shadowMapCount > 0)
    out.error("options.cameraThickness", "is 1, but backDepth holds thicknesses, which do not say what a shadow map hides; use 0");
  if (f.options.gatherSamples > 64 || f.options.gatherSamples % 4 != 0)
    out.error("options.gatherSamples", "is ", f.options.gatherSamples, "; needs a multiple of 4, at most 64");

  // Blocks, texels and probes hold the index in 8 bits, and 0 means none.
  if (f.materialCount == 0 || f.materialCount > 255 || !f.materials)
    out.error("materials", "has ", f.materialCount, f.materials ? "" : " at NULL", "; needs 1..255");
  checkMaterialBits(inputs, out);
  const uint32_t mark = inputs.thesis.materialMarkBit;
  if (mark != 0 && ((mark & (mark - 1)) != 0 || mark <= f.materialCount))
    out.error("thesis.materialMarkBit", "is ", mark, "; must be 0 or a power of two above the ",
              f.materialCount, " materials");
  else if (mark != 0 && f.options.materialShift < 32 && (mark & inputs.materialBits()) == 0)
    out.error("thesis.materialMarkBit", "is ", mark, ", which materialMask ", f.options.materialMask,
              " and materialShift ", f.options.materialShift, " leave out");
  for (uint32_t i = 0; f.options.ambient && i < kAmbientCoefficients; ++i)
    if (!(std::abs(f.options.ambient[i]) <= 1e15f))
      out.error("options.ambient", "[", i, "] is ", f.options.ambient[i], ", outside [-1e+15, 1e+15]");
  checkLightTables(f, out);
  const std::tuple<const char*, uint32_t, const void*> lists[] = {
      {"light", f.lightCount, f.lights},
      {"shadowMap", f.shadowMapCount, f.shadowMaps},
      {"shadowImage", f.shadowImageCount, f.shadowImages}};
  for (const auto& [name, count, first] : lists)
    if (count > 0 && !first) out.error(Field(name, "s"), "is NULL, but ", name, "Count is ", count);
  if (f.options.reuse == (PELLUCID_REUSE_ALTERNATE | PELLUCID_REUSE_COHERENCE))
    out.error("options.reuse",
              "is both; alternating would skip frames in which coherence asks for a refresh");
  else if (f.options.reuse > PELLUCID_REUSE_COHERENCE && f.options.reuse != PELLUCID_REUSE_ACCUMULATE)
    out.error("options.reuse", "is ", f.options.reuse, ", not a PellucidReuse");
}

void checkMaterials(const Inputs& inputs, Findings& out) {
  for (uint32_t i = 0; i < inputs.frame.materialCount; ++i)
    if (!hasTables(inputs.frame.materials[i]))
      out.error(Field("materials[", i, "].tables"), "are not of the material's fields; call pellucidMakeMaterialTables after a change");
}

namespace {

// Layouts in which shaders may read an image.
bool canBeRead(VkImageLayout layout) {
  return layout == VK_IMAGE_LAYOUT_GENERAL || layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL ||
         layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL ||
         layout == VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL ||
         layout == VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL || layout == VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL;
}

void checkLayout(const PellucidImage& image, const char* field, Findings& out) {
  if (given(image) && !canBeRead(image.layout))
    out.error(field, "is in VkImageLayout ", static_cast<int>(image.layout),
              "; shaders read images in GENERAL or a READ_ONLY layout");
}

void checkGeneral(const PellucidImage& image, const char* field, Findings& out) {
  if (given(image) && image.layout != VK_IMAGE_LAYOUT_GENERAL)
    out.error(field, "is in VkImageLayout ", static_cast<int>(image.layout), "; storage writes need GENERAL");
}

// The views that a recording needs.
void checkViews(const FrameFacts& facts, Findings& out) {
  const PellucidFrame& f = facts.frame;
  for (const ImageField& image : kImageFields)
    if (image.required && !given(f.*image.field)) out.error(image.name, "has no view, but is required");
  for (const ImageField& image : kImageFields)
    if (image.resource != PELLUCID_RESOURCE_OUTPUT) checkLayout(f.*image.field, image.name, out);
  for (uint32_t i = 0; i < f.shadowImageCount; ++i) {
    const Field field("shadowImages[", i, "]");
    if (!given(f.shadowImages[i])) out.error(field, "has no view");
    checkLayout(f.shadowImages[i], field, out);
  }
  if (facts.stages.keepsHistory) {
    if (!given(f.options.history))
      out.error("options.history", "has no view, but reuse needs it; see pellucidGetImageNeeds");
    if (facts.stages.accumulates && !given(f.motion))
      out.error("motion", "has no view, but reuse ACCUMULATE needs it");
    checkGeneral(f.options.history, "options.history", out);
  }
  uint32_t transients = 0;
  for (const MadeImage* image : transientImages()) transients += image->made(facts);
  for (uint32_t i = 0; i < transients; ++i) {
    const Field field("transients[", i, "]");
    if (!given(f.transients[i])) out.error(field, "has no view; see pellucidGetImageNeeds");
    checkGeneral(f.transients[i], field, out);
  }
  if (f.options.addToOutput == 1 && facts.inPlace())
    out.error("options.addToOutput", "is 1, but the output is the irradiance's view");
  if (facts.inPlace() && canBeRead(f.irradiance.layout)) checkGeneral(f.irradiance, "irradiance", out);
  checkGeneral(f.output, "output", out);
}

// Lights, from the first one on, whose shadow images the dispatches of a plan can bind; one more does not
// fit. Those of all lights do not.
uint32_t lightsThatFit(PellucidFrame frame) {
  PellucidPlan plan;
  uint32_t fit = 0, tooMany = frame.lightCount;
  while (tooMany - fit > 1) {  // halved: each try costs lights times materials
    frame.lightCount = fit + (tooMany - fit) / 2;
    const bool fits = pellucidBuildPlan(&frame, nullptr, &plan) != PELLUCID_ERROR_CAPACITY;
    (fits ? fit : tooMany) = frame.lightCount;
  }
  return fit;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidValidateFrame(const PellucidFrame* frame, PellucidMessageFn fn,
                                                void* user) {
  Findings out(fn, user);
  const auto facts = readFrame(frame, out);
  if (!facts) return out.result();
  PellucidPlan plan{};  // says what fits into it
  if (!addPasses(*facts, false, &plan))
    out.fail(PELLUCID_ERROR_CAPACITY, "shadowImages", "of all ", facts->frame.lightCount,
             " lights are more than the plan's ", static_cast<int>(PELLUCID_MAX_DISPATCHES),
             " dispatches can bind; those of the first ", lightsThatFit(facts->frame), " lights fit");
  else
    checkViews(*facts, out);
  return out.result();
}
