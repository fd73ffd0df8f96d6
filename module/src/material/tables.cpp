#include "material/tables.h"

#include <cmath>
#include <cstddef>

#include "domains.h"
#include "material/transmittance.h"

namespace pellucid {
namespace {

constexpr size_t kFields = offsetof(PellucidMaterial, tables);

// FNV-1a (Fowler, Noll and Vo), by words. Another version of the header makes other tables.
uint64_t fingerprintOf(const PellucidMaterial& m) {
  static_assert(kFields % sizeof(uint32_t) == 0);
  uint32_t words[kFields / sizeof(uint32_t)];
  std::memcpy(words, &m, kFields);
  uint64_t hash = 0xCBF29CE484222325u ^ PELLUCID_HEADER_VERSION;
  for (const uint32_t word : words) hash = (hash ^ word) * 0x100000001B3u;
  return hash;
}

void check(const PellucidMaterial& m, Findings& out) {
  checkDomains(m, "", out);
  if (m.gaussianCount > PELLUCID_MAX_GAUSSIANS) return;
  checkTransmittance(m, out);
  for (int c = 0; c < 3; ++c) {
    // Rounding of floats.
    if (m.thinWalled != 0 && !(m.reflectance[c] + m.wallTransmittance[c] <= 1 + 1e-6f))
      out.error("wallTransmittance", "of channel ", c, " is ", m.wallTransmittance[c], " with a reflectance of ",
                m.reflectance[c], "; more light leaves a thin wall than arrives");
    float sum = 0;
    for (uint32_t i = 0; i < m.gaussianCount; ++i) sum += m.gaussianWeight[c][i];
    // 1e-3: the accuracy to which constant irradiance is promised to stay constant.
    if (m.gaussianCount > 0 && !(std::abs(sum - 1) <= 1e-3f))
      out.error("gaussianWeight", "of channel ", c, " sums to ", sum, ", not 1");
  }
}

shared::MaterialConstants constantsOf(const PellucidMaterial& m) {
  shared::MaterialConstants c{};
  const bool canGather = canBeGathered(m.transmittanceModel) && m.thinWalled == 0;
  c.meta = {modelOf(m), m.gaussianCount, m.thinWalled, 0};
  if (canGather) c.gather = gatherConstants(m);
  // From other models the ambient light takes nothing from visible faces.
  for (glm::vec4& reflectance : c.gather.reflectance)
    if (!canGather) reflectance.x = 1;
  c.inverseReflectance.w = static_cast<float>(1 / static_cast<double>(static_cast<float>(halfThickness(m))));
  c.transmittance4.w = static_cast<float>(opaqueThickness(m));
  const auto exponent = static_cast<float>(gaussianExponent(modelOf(m)));
  for (int channel = 0; channel < 3; ++channel) {
    const std::array<float, 5> t = shaderParameters(m, channel);
    c.transmittance[channel] = {t[0], t[1], t[2], t[3]};
    c.transmittance4[channel] = t[4];
    c.inverseReflectance[channel] = 1 / m.reflectance[channel];
    for (uint32_t i = 0; i < m.gaussianCount; ++i) {
      c.gaussianFalloff[i][channel] = exponent / m.gaussianVariance[channel][i];
      c.gaussianWeight[i][channel] = m.gaussianWeight[channel][i];
    }
  }
  return c;
}

}  // namespace

bool hasTables(const PellucidMaterial& m) {
  static_assert(offsetof(MaterialTables, fingerprint) == 0);
  uint64_t fingerprint;
  std::memcpy(&fingerprint, m.tables, sizeof fingerprint);
  return fingerprint == fingerprintOf(m);
}

}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidMakeMaterialTables(PellucidMaterial* material, PellucidMessageFn message, void* messageUser) {
  Findings out(message, messageUser);
  if (material)
    check(*material, out);
  else
    out.error("material", "is NULL");
  if (!out.ok()) return out.result();
  const MaterialTables tables{fingerprintOf(*material), constantsOf(*material), kernelConstants(*material)};
  std::memset(material->tables, 0, sizeof material->tables);
  std::memcpy(material->tables, &tables, sizeof tables);
  return PELLUCID_OK;
}
