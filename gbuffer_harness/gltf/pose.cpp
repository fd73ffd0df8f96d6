#include "gltf/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "gltf/accessor.h"

namespace pellucid::harness {

namespace {

std::string nodeName(std::size_t node) { return "nodes[" + std::to_string(node) + "]"; }

// `values` when they are `count` finite numbers, `absent` when there are none.
std::vector<double> numbers(const GltfDocument& document, const std::vector<double>& values,
                            std::vector<double> absent, const std::string& field) {
  if (values.empty()) return absent;
  if (values.size() != absent.size() ||
      !std::all_of(values.begin(), values.end(), [](double v) { return std::abs(v) < 1e30; }))
    document.fail(field, "is not " + std::to_string(absent.size()) + " numbers below 1e30");
  return values;
}

Parts partsOf(const GltfDocument& document, std::size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  const std::string field = nodeName(index) + ".";
  return {numbers(document, node.translation, {0, 0, 0}, field + "translation"),
          numbers(document, node.rotation, {0, 0, 0, 1}, field + "rotation"),
          numbers(document, node.scale, {1, 1, 1}, field + "scale")};
}

glm::dmat4 matrixOfNode(const GltfDocument& document, std::size_t index, const Parts& parts) {
  return matrixOf(document, parts, nodeName(index) + ".rotation");
}

glm::dmat4 stillTransform(const GltfDocument& document, std::size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  if (node.matrix.empty()) return matrixOfNode(document, index, partsOf(document, index));
  const std::string field = nodeName(index) + ".matrix";
  const auto m = numbers(document, node.matrix, std::vector<double>(16), field);
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
  if (glm::transpose(matrix)[3] != glm::dvec4(0, 0, 0, 1))
    document.fail(field, "its last row is not 0, 0, 0, 1");
  return matrix;
}

const GltfJson& array(const GltfDocument& document, const GltfJson& object, const char* key,
                      const std::string& field) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array())
    document.fail(field + "." + key, "is missing or not an array");
  return *found;
}

// The value of an animation's sampler at a time: `size` numbers.
class Sampler {
public:
  Sampler(const GltfDocument& document, const GltfJson& sampler, const std::string& field)
      : times_(readFloats(document, document.reference(sampler, "input", field), 1, 1, field + ".input")),
        values_(readFloats(document, document.reference(sampler, "output", field), 1, 4, field + ".output")) {
    const auto interpolation = sampler.find("interpolation");
    const GltfJson kind = interpolation == sampler.end() ? GltfJson("LINEAR") : *interpolation;
    if (kind != "LINEAR" && kind != "STEP" && kind != "CUBICSPLINE")
      document.fail(field + ".interpolation", kind.dump() + " is not LINEAR, STEP or CUBICSPLINE");
    step_ = kind == "STEP";
    cubic_ = kind == "CUBICSPLINE";
    for (std::size_t i = 1; i < times_.data.size(); ++i)
      if (!(times_.data[i] > times_.data[i - 1]))
        document.fail(field + ".input", "its times do not grow at element " + std::to_string(i));
    const std::size_t perKey = times_.data.size() * (cubic_ ? 3 : 1);
    if (values_.data.size() % perKey != 0)
      document.fail(field + ".output", std::to_string(values_.data.size()) +
                                           " numbers are not as many for each of " +
                                           std::to_string(times_.data.size()) + " times");
    size_ = values_.data.size() / perKey;
  }

  std::size_t size() const { return size_; }

  std::vector<double> at(double seconds, bool isRotation) const {
    const std::vector<float>& t = times_.data;
    const auto after = std::upper_bound(t.begin(), t.end(), seconds);
    if (after == t.begin()) return key(0);
    const auto i = static_cast<std::size_t>(after - t.begin()) - 1;
    if (after == t.end() || step_) return key(i);
    const double length = static_cast<double>(t[i + 1]) - t[i], u = (seconds - t[i]) / length;
    if (cubic_) return spline(i, u, length);
    std::vector<double> a = key(i), b = key(i + 1);
    if (isRotation && size_ == 4) {
      const glm::dquat q = glm::slerp(glm::normalize(glm::dquat(a[3], a[0], a[1], a[2])),
                                      glm::normalize(glm::dquat(b[3], b[0], b[1], b[2])), u);
      return {q.x, q.y, q.z, q.w};
    }
    for (std::size_t c = 0; c < size_; ++c) a[c] += u * (b[c] - a[c]);
    return a;
  }

private:
  // part 0 and 2 of a cubic key are its tangents.
  double number(std::size_t keyIndex, std::size_t part, std::size_t c) const {
    return values_.data[(cubic_ ? 3 * keyIndex + part : keyIndex) * size_ + c];
  }
  std::vector<double> key(std::size_t i) const {
    std::vector<double> result(size_);
    for (std::size_t c = 0; c < size_; ++c) result[c] = number(i, 1, c);
    return result;
  }
  // glTF 2.0, appendix C.5.
  std::vector<double> spline(std::size_t i, double u, double length) const {
    const double uu = u * u, uuu = uu * u;
    std::vector<double> result(size_);
    for (std::size_t c = 0; c < size_; ++c)
      result[c] = (2 * uuu - 3 * uu + 1) * number(i, 1, c) + length * (uuu - 2 * uu + u) * number(i, 2, c) +
                  (3 * uu - 2 * uuu) * number(i + 1, 1, c) + length * (uuu - uu) * number(i + 1, 0, c);
    return result;
  }

  AccessorValues times_, values_;
  std::size_t size_ = 0;
  bool step_ = false, cubic_ = false;
};

std::size_t findAnimation(const GltfDocument& document, const std::string& name) {
  const auto animations = document.json.find("animations");
  const std::size_t count = animations == document.json.end() ? 0 : animations->size();
  if (count == 0) document.fail("animations", "the file has none to take a time of");
  if (name.empty()) return 0;
  std::string names;
  for (std::size_t i = 0; i < count; ++i) {
    const auto own = (*animations)[i].find("name");
    const std::string number = std::to_string(i);
    if (name == number) return i;
    if (own != (*animations)[i].end() && *own == name) return i;
    names += (i ? ", " : "") +
             (own != (*animations)[i].end() && own->is_string() ? own->get<std::string>() : number);
  }
  document.fail("animations", "none is named \"" + name + "\"; there are " + names);
}

void animate(const GltfDocument& document, double seconds, const std::string& name, Pose& pose,
             std::vector<std::string>& warnings) {
  const std::size_t index = findAnimation(document, name);
  const GltfJson& animation = document.json["animations"][index];
  const std::string field = "animations[" + std::to_string(index) + "]";
  const GltfJson &samplers = array(document, animation, "samplers", field),
                 &channels = array(document, animation, "channels", field);
  std::map<std::size_t, Parts> moved;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string channel = field + ".channels[" + std::to_string(i) + "]";
    if (!channels[i].is_object() || !channels[i].contains("target") || !channels[i]["target"].is_object())
      document.fail(channel + ".target", "is missing");
    const GltfJson& target = channels[i]["target"];
    const std::string path = target.value("path", GltfJson()).is_string() ? target["path"] : GltfJson("");
    if (!target.contains("node")) {
      warnings.push_back(channel + ": path \"" + path + "\" without a node is ignored");
      continue;
    }
    const std::size_t node = document.index(document.reference(target, "node", channel + ".target"),
                                            document.model.nodes.size(), channel + ".target.node", "nodes");
    const std::size_t samplerIndex = document.index(document.reference(channels[i], "sampler", channel),
                                                    samplers.size(), channel + ".sampler", "samplers");
    const Sampler sampler(document, samplers[samplerIndex],
                          field + ".samplers[" + std::to_string(samplerIndex) + "]");
    const bool isRotation = path == "rotation";
    const std::vector<double> value = sampler.at(seconds, isRotation);
    if (path == "weights") {
      pose.weights[node] = value;
      continue;
    }
    if (!document.model.nodes[node].matrix.empty())
      document.fail(nodeName(node) + ".matrix",
                    "stands where " + channel + " needs translation, rotation and scale");
    Parts& parts = moved.try_emplace(node, partsOf(document, node)).first->second;
    std::vector<double>* to = path == "translation" ? &parts.translation
                              : isRotation          ? &parts.rotation
                              : path == "scale"     ? &parts.scale
                                                    : nullptr;
    if (!to)
      document.fail(channel + ".target.path",
                    "\"" + path + "\" is not translation, rotation, scale or weights");
    if (value.size() != to->size())
      document.fail(channel + ".sampler", std::to_string(value.size()) + " numbers are no " + path);
    *to = value;
  }
  for (const auto& [node, parts] : moved) pose.parentFromNode[node] = matrixOfNode(document, node, parts);
}

}  // namespace

glm::dmat4 matrixOf(const GltfDocument& document, const Parts& parts, const std::string& rotationField) {
  const auto &t = parts.translation, &r = parts.rotation, &s = parts.scale;
  const glm::dquat rotation(r[3], r[0], r[1], r[2]);
  if (!(glm::length(rotation) > 0)) document.fail(rotationField, "is a quaternion of length 0");
  return glm::translate(glm::dmat4(1), {t[0], t[1], t[2]}) * glm::mat4_cast(glm::normalize(rotation)) *
         glm::scale(glm::dmat4(1), {s[0], s[1], s[2]});
}

Pose readPose(const GltfDocument& document, std::optional<double> seconds, const std::string& animation,
              std::vector<std::string>& warnings) {
  Pose pose;
  if (seconds) animate(document, *seconds, animation, pose, warnings);
  return pose;
}

glm::dmat4 parentFromNode(const GltfDocument& document, const Pose& pose, std::size_t node) {
  const auto animated = pose.parentFromNode.find(node);
  return animated == pose.parentFromNode.end() ? stillTransform(document, node) : animated->second;
}

std::vector<glm::dmat4> readJoints(const GltfDocument& document, int skin,
                                   const std::vector<std::optional<glm::dmat4>>& worldFromNode,
                                   const std::string& field) {
  const auto skins = document.json.find("skins");
  const std::size_t index =
      document.index(skin, skins == document.json.end() ? 0 : skins->size(), field, "skins");
  const GltfJson& source = (*skins)[index];
  const std::string name = "skins[" + std::to_string(index) + "]";
  const GltfJson& joints = array(document, source, "joints", name);
  std::optional<AccessorValues> inverse;
  if (source.contains("inverseBindMatrices")) {
    inverse = readFloats(document, document.reference(source, "inverseBindMatrices", name), 16, 16,
                         name + ".inverseBindMatrices");
    if (inverse->count() < joints.size())
      document.fail(name + ".inverseBindMatrices", "are " + std::to_string(inverse->count()) + " for " +
                                                       std::to_string(joints.size()) + " joints");
  }
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string joint = name + ".joints[" + std::to_string(i) + "]";
    if (!joints[i].is_number_unsigned() || joints[i].get<std::uint64_t>() >= worldFromNode.size())
      document.fail(
          joint, joints[i].dump() + " is not one of the " + std::to_string(worldFromNode.size()) + " nodes");
    const std::optional<glm::dmat4>& world = worldFromNode[joints[i].get<std::size_t>()];
    if (!world) document.fail(joint, nodeName(joints[i].get<std::size_t>()) + " is not in the scene");
    glm::dmat4 bind(1);
    for (int k = 0; inverse && k < 16; ++k) bind[k / 4][k % 4] = static_cast<double>((*inverse)[i][k]);
    result.push_back(*world * bind);
  }
  return result;
}

}  // namespace pellucid::harness
