// A valid frame without images, to be bent by tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <deque>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "pellucid/pellucid_thesis.h"

namespace pellucid::test {

// skin1-like numbers; only their validity matters where no picture is compared.
inline PellucidMaterial plainMaterial() {
  static const PellucidMaterial material = [] {
    PellucidMaterial m{};
    m.transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
    m.gaussianCount = 2;
    for (int c = 0; c < 3; ++c) {
      const float t[5] = {0.6f, 0.5f, 0.3f, 2.0f, 0};
      std::copy(t, t + 5, m.transmittance[c]);
      m.reflectance[c] = 0.5f;
      m.gaussianVariance[c][0] = 0.2f;
      m.gaussianVariance[c][1] = 2.0f;
      m.gaussianWeight[c][0] = 0.4f;
      m.gaussianWeight[c][1] = 0.6f;
      m.radius[c] = 5;
    }
    EXPECT_EQ(pellucidMakeMaterialTables(&m, nullptr, nullptr), PELLUCID_OK);
    return m;
  }();
  return material;
}

struct Frame {
  PellucidFrame frame;
  PellucidThesisOptions thesis;
  PellucidMaterial material = plainMaterial();
  std::vector<PellucidLight> lights;
  std::vector<PellucidShadowMap> maps;
  std::vector<PellucidImage> images;

  // One directional light per shadow image; without images one light without a map.
  explicit Frame(uint32_t shadowImages = 1) {
    pellucidInitFrame(&frame);
    frame.options.indirectDispatches = 0;  // tests of lists ask for them
    pellucidInitThesisOptions(&thesis);
    frame.options.thesis = &thesis;
    frame.options.gatherSamples = 0;  // tests of the gather say so
    frame.imageExtent[0] = 100;
    frame.imageExtent[1] = 50;
    frame.metersPerUnit = 0.001f;
    const float projection[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};  // reversed, infinite
    std::copy(projection, projection + 16, frame.clipFromView);
    frame.frontDepth = frame.backDepth = frame.irradiance = frame.material = frame.output = view();
    for (uint32_t i = 0; i < shadowImages; ++i) {
      PellucidShadowMap map{};
      map.image = i;
      map.extent[0] = map.extent[1] = 64;
      const float clip[16] = {0.1f, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0.5f, 1};
      std::copy(clip, clip + 16, map.clipFromWorld);
      maps.push_back(map);
      images.push_back(view());
      lights.push_back(light(i, 1));
    }
    if (shadowImages == 0) lights.push_back(light(0, 0));
    use();
  }
  Frame(const Frame&) = delete;

  // After a change to the vectors.
  void use() {
    frame.materialCount = 1;
    frame.materials = &material;
    frame.lightCount = static_cast<uint32_t>(lights.size());
    frame.lights = lights.data();
    frame.shadowMapCount = static_cast<uint32_t>(maps.size());
    frame.shadowMaps = maps.data();
    frame.shadowImageCount = static_cast<uint32_t>(images.size());
    frame.shadowImages = images.data();
  }

  // Makes the tables of all materials, after a change to their fields; the messages of those that have wrong values.
  std::string tables() const {
    std::string text;
    // A material's tables take milliseconds: those of the last materials are kept.
    thread_local std::deque<PellucidMaterial> made{plainMaterial()};
    for (uint32_t i = 0; frame.materials && frame.materialCount <= 255 && i < frame.materialCount; ++i) {
      auto* m = const_cast<PellucidMaterial*>(&frame.materials[i]);
      const auto same = std::find_if(made.begin(), made.end(), [&](const PellucidMaterial& other) {
        return std::memcmp(&other, m, offsetof(PellucidMaterial, tables)) == 0;
      });
      if (same != made.end()) {
        *m = *same;
        continue;
      }
      std::string wrong;
      const PellucidResult result = pellucidMakeMaterialTables(
          m,
          [](void* user, PellucidSeverity, const char* field, const char* message) {
            *static_cast<std::string*>(user) += std::string(field) + " " + message + "\n";
          },
          &wrong);
      if (!wrong.empty()) text += "materials[" + std::to_string(i) + "]." + wrong;
      if (result == PELLUCID_OK) made.push_back(*m);
      if (made.size() > 16) made.pop_front();
    }
    return text;
  }

  PellucidPlan plan() const {
    tables();
    PellucidPlan plan;
    EXPECT_EQ(pellucidBuildPlan(&frame, nullptr, &plan), PELLUCID_OK) << problems();
    return plan;
  }

  // Every message of pellucidValidateFrame, "field message" a line.
  std::string problems(PellucidSeverity least = PELLUCID_SEVERITY_ERROR) const {
    struct All {
      PellucidSeverity least;
      std::string text;
    } all{least, tables()};
    if (!all.text.empty()) return all.text;
    pellucidValidateFrame(
        &frame,
        [](void* user, PellucidSeverity severity, const char* field, const char* message) {
          auto& a = *static_cast<All*>(user);
          if (severity >= a.least) a.text += std::string(field) + " " + message + "\n";
        },
        &all);
    return all.text;
  }

  // Planning never dereferences a view.
  static PellucidImage view() {
    return {reinterpret_cast<VkImageView>(uintptr_t{1}), VK_IMAGE_LAYOUT_GENERAL};
  }

  static PellucidLight light(uint32_t firstMap, uint32_t mapCount) {
    PellucidLight l{};
    l.type = PELLUCID_LIGHT_DIRECTIONAL;
    l.direction[2] = 1;
    l.color[0] = l.color[1] = l.color[2] = 1;
    l.intensity = 3;
    l.firstShadowMap = firstMap;
    l.shadowMapCount = mapCount;
    return l;
  }
};

// Lacks no image that validation asks for.
struct CompleteFrame : Frame {
  explicit CompleteFrame(uint32_t shadowImages = 1) : Frame(shadowImages) {
    for (PellucidImage& image : frame.transients) image = view();
  }
};

// What a dispatch of the plan binds.
inline std::vector<PellucidBinding> bindingsOf(const PellucidPlan& plan, const PellucidDispatch& dispatch) {
  std::vector<PellucidBinding> all(PELLUCID_MAX_BINDINGS);
  all.resize(pellucidGetBindings(&plan, static_cast<uint32_t>(&dispatch - plan.dispatches), all.data()));
  return all;
}

// The bindings of a pipeline.
inline std::vector<PellucidBinding> bindingsOf(uint32_t pipeline) {
  std::vector<PellucidBinding> all(PELLUCID_MAX_BINDINGS);
  all.resize(pellucidGetPipelineBindings(pipeline, all.data()));
  return all;
}

// Names of the plan's dispatches, in their order.
inline std::vector<std::string> names(const PellucidPlan& plan) {
  std::vector<std::string> result;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) result.emplace_back(plan.dispatches[i].name);
  return result;
}

// All that a plan says, for comparisons. Names are static strings, so their addresses stand for them.
inline std::string bytesOf(const PellucidPlan& plan) {
  static_assert(std::has_unique_object_representations_v<PellucidDispatch>, "padding may differ");
  std::string all(reinterpret_cast<const char*>(plan.dispatches), plan.dispatchCount * sizeof(PellucidDispatch));
  all.append(reinterpret_cast<const char*>(plan.shadowImages), sizeof plan.shadowImages);
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    all += plan.skips[i].what + std::string(plan.skips[i].reason) + std::to_string(plan.skips[i].count);
  for (const uint32_t number : {plan.activeLights, plan.gatherSamples, plan.historyAge})
    all += std::to_string(number) + " ";
  return all + std::to_string(plan.constantsSize);
}

// How many of this the plan skips.
inline uint32_t skipped(const PellucidPlan& plan, const std::string& what) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    if (plan.skips[i].what == what) count += plan.skips[i].count;
  return count;
}

}  // namespace pellucid::test
