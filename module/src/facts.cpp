#include "facts.h"

#include <cstddef>
#include <cstring>

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
#define RANGE(first, last)                \
  bytes + offsetof(PellucidFrame, first), \
      offsetof(PellucidFrame, last) + sizeof(PellucidFrame::last) - offsetof(PellucidFrame, first)

Facts factsOf(const PellucidFrame& f) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&f);
  Hash hash[PELLUCID_FACT_COUNT];
  hash[PELLUCID_FACT_SIZE].add(RANGE(imageExtent, renderRect));
  hash[PELLUCID_FACT_CAMERA].add(RANGE(metersPerUnit, viewFromWorld));
  const PellucidImage* optional[] = {&f.backDepth, &f.normal, &f.albedo};
  for (const PellucidImage* image : optional) {
    const unsigned char isGiven = given(*image) ? 1 : 0;
    hash[PELLUCID_FACT_IMAGES].add(&isGiven, 1);
  }
  Hash& settings = hash[PELLUCID_FACT_SETTINGS];
  settings.add(RANGE(features, features));
  settings.add(RANGE(outputFormat, normalsInViewSpace));
  settings.add(RANGE(thicknessSource, minimumDotTableSize));
  settings.add(RANGE(faceVector, frameLoad));
  settings.add(RANGE(prescaleAngle, indirectDispatches));
  if (f.minimumDotTable) settings.add(f.minimumDotTable, minimumDotEntries(f) * sizeof(float));
  hash[PELLUCID_FACT_MATERIALS].add(f.materials, f.materialCount * sizeof(PellucidMaterial));
  hash[PELLUCID_FACT_LIGHTS].add(f.lights, f.lightCount * sizeof(PellucidLight));
  hash[PELLUCID_FACT_SHADOW_MAPS].add(f.shadowMaps, f.shadowMapCount * sizeof(PellucidShadowMap));
  hash[PELLUCID_FACT_SHADOW_IMAGES].add(RANGE(shadowImageCount, shadowImageCount));
  Facts facts;
  for (int i = 0; i < PELLUCID_FACT_COUNT; ++i) facts.hash[i] = hash[i].value();
  return facts;
}
#undef RANGE

const char* nameOf(PellucidFact fact) {
  constexpr const char* kNames[PELLUCID_FACT_COUNT] = {
      "imageExtent or renderRect", "camera",         "set of optional images", "group of settings",
      "list of materials",         "list of lights", "list of shadowMaps",     "shadowImageCount"};
  return kNames[fact];
}

}  // namespace pellucid
