// Small glTF files read from a folder that goes away with the test.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <initializer_list>
#include <string>

#include "common/error.h"
#include "gltf/gltf.h"
#include "gltf_builder.h"
#include "unit/capture_samples.h"

namespace pellucid::test {

namespace fs = std::filesystem;
using namespace pellucid::harness;
using Json = nlohmann::ordered_json;

// A folder that goes away with the test.
class Gltf : public testing::Test {
protected:
  fs::path write(const std::string& name, const std::string& bytes) const {
    writeText(folder_ / name, bytes);
    return folder_ / name;
  }
  // The error of loadGltf for these bytes, or "accepted".
  std::string refusal(const std::string& bytes, const std::string& name = "t.glb",
                      const GltfOptions& options = {}) const {
    return refusalOf([&] { loadGltf(write(name, bytes), options); });
  }
  void expectRefused(const std::string& bytes, std::initializer_list<const char*> words,
                     const std::string& name = "t.glb", const GltfOptions& options = {}) const {
    const std::string sentence = refusal(bytes, name, options);
    EXPECT_NE(sentence.find(name), std::string::npos) << "the file is not named: " << sentence;
    for (const char* word : words)
      EXPECT_NE(sentence.find(word), std::string::npos) << "\"" << word << "\" is not in: " << sentence;
  }

  // Rows of a pointer into the file's JSON, the value that is put there or "removed", and what the error
  // names.
  void expectRefusals(const std::function<GltfBuilder()>& good, const char* rows,
                      const GltfOptions& options = {}) const {
    for (const std::vector<std::string>& cells : tableOf(rows)) {
      SCOPED_TRACE(testing::PrintToString(cells));
      ASSERT_GE(cells.size(), 3u);
      GltfBuilder b = good();
      const Json::json_pointer pointer(cells[0]);
      if (cells[1] == "removed")
        b.json[pointer.parent_pointer()].erase(pointer.back());
      else
        b.json[pointer] = Json::parse(cells[1]);
      const std::string sentence = refusal(b.glb(), "t.glb", options);
      EXPECT_NE(sentence.find("t.glb"), std::string::npos) << sentence;
      for (std::size_t i = 2; i < cells.size(); ++i)
        EXPECT_NE(sentence.find(cells[i]), std::string::npos) << cells[i] << " is not in: " << sentence;
    }
  }

  TemporaryDirectory folder_;
};

// Two triangles of the square [0, 2]^2 at z = 0, facing +z, of material "m".
inline GltfBuilder square() {
  GltfBuilder b;
  const int position = b.vectors({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
  const int normal = b.vectors({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int indices = b.indices({0, 1, 2, 0, 2, 3});
  b.json["meshes"] = {{{"primitives",
                        {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                          {"indices", indices},
                          {"material", 0}}}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  b.json["materials"] = {{{"name", "m"}}};
  return b;
}

inline glm::dvec3 corner(const Model& model, std::size_t i) {
  const auto& p = model.vertices[model.indices[i]].position;
  return {p[0], p[1], p[2]};
}

// Normal of a triangle by its winding, as long as twice its area.
inline glm::dvec3 winding(const Model& model, std::size_t triangle) {
  const glm::dvec3 a = corner(model, 3 * triangle);
  return glm::cross(corner(model, 3 * triangle + 1) - a, corner(model, 3 * triangle + 2) - a);
}

inline void expectVector(const std::array<float, 3>& v, double x, double y, double z,
                         double tolerance = 1e-6) {
  EXPECT_NEAR(v[0], x, tolerance);
  EXPECT_NEAR(v[1], y, tolerance);
  EXPECT_NEAR(v[2], z, tolerance);
}

// True if one of the sentences holds these words.
inline bool says(const std::vector<std::string>& sentences, const std::string& words) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

}  // namespace pellucid::test
