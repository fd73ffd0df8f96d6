#include "lights.h"

#include <algorithm>

#include "constants.h"
#include "cull.h"
#include "entry_points.h"

namespace pellucid {

void Skips::add(const char* what, const char* reason) {
  for (uint32_t i = 0; i < size; ++i)
    if (list[i].what == what && list[i].reason == reason) {
      ++list[i].count;
      return;
    }
  if (size < list.size()) list[size++] = {what, reason, 1};
}

// ---- A group

uint32_t LightGroup::slot(uint32_t image) const {
  for (uint32_t i = 0; i < imageCount; ++i)
    if (images[i] == image) return i;
  return mostImages;
}

bool LightGroup::addImage(uint32_t image) {
  if (slot(image) < mostImages) return true;
  if (imageCount == mostImages) return false;
  images[imageCount++] = image;
  return true;
}

bool LightGroup::addImages(const Setup& setup, const PellucidLight& light, const PellucidShadowMap& map) {
  return addImage(map.image) && (!readsExit(setup, light, map) || addImage(map.options.exitImage - 1)) &&
         (!readsCaster(map) || addImage(map.options.casterMaterialImage - 1));
}

bool LightGroup::readsExit(const Setup& setup, const PellucidLight& light,
                           const PellucidShadowMap& map) const {
  return beside && map.options.exitImage != 0 && map.options.backFaces == 0 &&
         (setup.frame.options.cameraThickness == 0 || setup.isGathered(light));
}

bool LightGroup::addLight(const Setup& setup, const PellucidLight& light) {
  const bool isGathered = setup.isGathered(light);
  // Probes and the pass of one thickness a pixel take groups of their own.
  if (hasProbes() && !isGathered) return false;
  LightGroup grown = *this;
  // Dispatches of thin walls' light would read the images, too.
  if (isGathered && !setup.thinWalls) grown.mostImages = PELLUCID_ENTRY_IMAGE_COUNT;
  grown.shadowCount += light.shadowMapCount;
  if (lightCount == PELLUCID_DISPATCH_LIGHTS || grown.shadowCount > PELLUCID_DISPATCH_SHADOWS) return false;
  for (uint32_t i = 0; i < light.shadowMapCount; ++i)
    if (!grown.addImages(setup, light, setup.frame.shadowMaps[light.firstShadowMap + i])) return false;
  if (isGathered) {
    for (uint32_t i = 0; i < light.shadowMapCount; ++i) {
      const EntryExtent extent = entryExtent(setup, light, i);
      grown.entryColumns = std::max(grown.entryColumns, wholeGroups(extent.width));
      grown.entryRows += wholeGroups(extent.height);
      grown.entryWidth = std::max(grown.entryWidth, extent.width);
      grown.entryHeight = std::max(grown.entryHeight, extent.height);
      grown.entryGroups += extent.groups();
    }
    if (grown.entryRows > kEntryRows) return false;
    ++grown.gathered;
  }
  ++grown.lightCount;
  *this = grown;
  return true;
}

LightGroup LightGroup::next() const {
  LightGroup next;
  next.beside = beside;
  next.firstLight = firstLight + lightCount;
  next.lightBytes = lightBytes + aligned(lightCount * sizeof(shared::LightConstants));
  next.shadowBytes = shadowBytes + aligned(shadowCount * sizeof(shared::ShadowConstants));
  next.gatherMapBytes = gatherMapBytes + aligned(shadowCount * sizeof(shared::GatherMapConstants));
  next.entryMapBytes = entryMapBytes + aligned(shadowCount * sizeof(shared::EntryMapConstants));
  return next;
}

// ---- All lights

Lights::Lights(const Setup& setup, Findings& out) {
  const PellucidFrame& frame = setup.frame;
  ambient = {};
  ambient.type = PELLUCID_SHADER_LIGHT_AMBIENT;
  std::fill_n(ambient.color, 3, 1.0f);
  const float* sky = frame.options.ambient;
  const bool bright = sky && std::any_of(sky, sky + kAmbientCoefficients, [](float c) { return c != 0; });
  ambient.intensity = bright || given(frame.hiddenIrradiance) ? 1 : 0;
  // The debug view of thickness shows the chord, too.
  needsChord = frame.options.cameraThickness == 1 || ambient.intensity > 0 ||
               frame.options.debugView == PELLUCID_DEBUG_THICKNESS;
  const ViewBounds view(setup);
  // True where the light contributes.
  const auto look = [&](const PellucidLight& light, const char* what, const char* field) {
    if (const char* reason = view.whySkipped(light)) {
      out.warning(field, "adds nothing: ", reason);
      skips.add(what, reason);
      return false;
    }
    if (setup.lacksChord(light) && setup.solids)
      skips.add("light in solids", "no back depth to take a thickness from: thin walls alone let it through");
    return true;
  };
  uint32_t gatheredFirst = 0;
  for (uint32_t i = 0; i < frame.lightCount; ++i) {
    const PellucidLight& light = frame.lights[i];
    needsChord = needsChord || setup.takesChord(light);
    if (!look(light, "light", Field("lights[", i, "]"))) continue;
    if (setup.holdsBackFaces(light)) ++holdBackFaces;
    for (uint32_t k = 0; k < light.shadowMapCount && !setup.holdsBackFaces(light); ++k) {
      const PellucidShadowMap& map = frame.shadowMaps[light.firstShadowMap + k];
      lackExit = lackExit || (map.options.exitImage == 0 && frame.options.cameraThickness == 0);
      lackCaster = lackCaster || map.options.casterMaterialImage == 0;
    }
    if (++lightCount > kMost) continue;
    active[lightCount - 1] = i;
    if (setup.isGathered(light))
      std::rotate(active.begin() + gatheredFirst++, active.begin() + (lightCount - 1),
                  active.begin() + lightCount);
  }
  if (ambient.intensity > 0 &&
      look(ambient, "ambient light", frame.options.ambient ? "options.ambient" : "hiddenIrradiance")) {
    if (lightCount < kMost) active[lightCount] = kAmbient;
    ++lightCount;
  }

  group(setup, true);
  const auto hasNothing = [](const PellucidShadowMap& map) {
    return map.options.exitImage == 0 && map.options.casterMaterialImage == 0;
  };
  if (std::all_of(frame.shadowMaps, frame.shadowMaps + frame.shadowMapCount, hasNothing)) return;
  // Base level, downsample, coarse levels, upsample and diffuse; add history, which no frame with a gather has.
  const uint32_t others = gathered > 0 ? 5 : 6;
  // Debug views of light need all lights in one dispatch.
  const bool binds = setup.debug() && frame.options.debugView != PELLUCID_DEBUG_IRRADIANCE
                         ? count <= 1
                         : fused() + gatherDispatches() + walls + others <= PELLUCID_MAX_DISPATCHES;
  if (!binds) group(setup, false);
}

void Lights::group(const Setup& setup, bool withBeside) {
  beside = withBeside;
  count = gathered = entryColumns = entryRows = entryGroups = 0;
  LightGroup current;
  current.beside = beside;
  current.shapes = setup.shapes;
  const auto put = [&] {
    if (count < first.size()) first[count] = current;
    last = current;
    ++count;
    if (current.hasProbes()) ++gathered;
    entryColumns = std::max(entryColumns, current.entryColumns);
    entryRows = std::max(entryRows, current.entryRows);
    entryGroups = std::max(entryGroups, current.entryGroups);
  };
  for (uint32_t i = 0; i < std::min(lightCount, kMost); ++i) {
    if (current.addLight(setup, light(setup, i))) continue;
    put();
    current = current.next();
    current.addLight(setup, light(setup, i));
  }
  if (current.lightCount > 0 || current.shapes) put();
  walls = setup.gathers && setup.thinWalls && lightCount > 0 ? count - (first[0].lightCount == 0 ? 1 : 0) : 0;
}

}  // namespace pellucid
