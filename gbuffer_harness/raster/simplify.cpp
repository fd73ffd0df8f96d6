#include "raster/simplify.h"

#include <meshoptimizer.h>

#include <string>

#include "common/error.h"

namespace pellucid::harness {

Model simplified(const Model& model, double ratio) {
  if (!(ratio > 0 && ratio <= 1))
    throw InputError(model.name, "simplify", std::to_string(ratio) + " is not above 0 and at most 1");
  Model result = model;
  if (ratio == 1) return result;
  constexpr float kAnyError = 1;  // of the model's extents: the ratio alone ends the collapse
  result.indices.clear();
  for (Part& part : result.parts) {
    const std::uint32_t* const triangles = model.indices.data() + part.firstIndex;
    const std::size_t wanted = static_cast<std::size_t>(ratio * part.indexCount / 3) * 3;
    std::vector<std::uint32_t> kept(part.indexCount);
    // A part is not emptied: it would let all light through.
    if (const std::size_t count =
            meshopt_simplify(kept.data(), triangles, part.indexCount, &model.vertices[0].position[0],
                             model.vertices.size(), sizeof(Vertex), wanted, kAnyError, 0, nullptr);
        count > 0)
      kept.resize(count);
    else
      kept.assign(triangles, triangles + part.indexCount);
    part.firstIndex = static_cast<std::uint32_t>(result.indices.size());
    part.indexCount = static_cast<std::uint32_t>(kept.size());
    result.indices.insert(result.indices.end(), kept.begin(), kept.end());
  }
  return result;
}

}  // namespace pellucid::harness
