#include "frame_hash.h"

#include <cstddef>
#include <iterator>

#include "frame.h"
#include "minimum_dot.h"

namespace pellucid {
namespace {

// FNV-1a, http://www.isthe.com/chongo/tech/comp/fnv
class Hash {
public:
  void add(const void* data, size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 16777619u;
  }
  uint32_t value() const { return value_; }

private:
  uint32_t value_ = 2166136261u;
};

}  // namespace

// Fields of four bytes that follow each other have no padding between them.
#define RANGE(object, first, last)                                                     \
  reinterpret_cast<const unsigned char*>(&(object).first),                             \
      static_cast<size_t>(reinterpret_cast<const unsigned char*>(&(object).last + 1) - \
                          reinterpret_cast<const unsigned char*>(&(object).first))

FrameHash hashOf(const FrameFacts& facts) {
  const PellucidFrame& f = facts.frame;
  const PellucidThesisOptions& t = facts.thesis;
  Hash hash[static_cast<size_t>(FramePart::Count)];
  const auto of = [&](FramePart part) -> Hash& { return hash[static_cast<size_t>(part)]; };
  of(FramePart::Size).add(RANGE(f, imageExtent, renderRect));
  of(FramePart::Camera).add(RANGE(f, metersPerUnit, viewFromWorld));
  for (const ImageField& image : kImageFields) {
    const unsigned char isGiven = !image.required && given(f.*image.field) ? 1 : 0;
    of(FramePart::Images).add(&isGiven, 1);
  }
  const unsigned char nothing = facts.stages.nothing ? 1 : 0;
  of(FramePart::Images).add(&nothing, 1);
  Hash& settings = of(FramePart::Settings);
  settings.add(RANGE(f, features, features));
  settings.add(RANGE(f, outputFormat, normalsInViewSpace));
  settings.add(RANGE(f, thicknessSource, debugView));
  settings.add(RANGE(t, angleModel, objectCenter));
  if (t.minimumDotTable) settings.add(t.minimumDotTable, minimumDotEntries(t) * sizeof(float));
  settings.add(RANGE(f, gatherSamples, frameLoad));
  settings.add(RANGE(f, targetError, preExposure));
  if (f.ambient) of(FramePart::Lights).add(f.ambient, kAmbientCoefficients * sizeof *f.ambient);
  for (uint32_t i = 0; i < f.materialCount; ++i) {
    const PellucidMaterial material = facts.material(i);
    of(FramePart::Materials).add(&material, sizeof material);
  }
  of(FramePart::Lights).add(f.lights, f.lightCount * sizeof(PellucidLight));
  of(FramePart::Lights).add(f.lightTables, f.lightTableCount * sizeof(PellucidLightTable));
  of(FramePart::ShadowMaps).add(f.shadowMaps, f.shadowMapCount * sizeof(PellucidShadowMap));
  of(FramePart::ShadowImages).add(RANGE(f, shadowImageCount, shadowImageCount));
  FrameHash result;
  for (size_t i = 0; i < result.size(); ++i) result[i] = hash[i].value();
  return result;
}
#undef RANGE

const char* nameOf(FramePart part) {
  constexpr const char* kNames[] = {
      "imageExtent or renderRect", "camera",         "set of optional images", "group of settings",
      "list of materials",         "list of lights", "list of shadowMaps",     "shadowImageCount"};
  static_assert(std::size(kNames) == static_cast<size_t>(FramePart::Count));
  return kNames[static_cast<size_t>(part)];
}

}  // namespace pellucid
