// A deferred renderer: shadow maps, G-buffer, lighting, Pellucid, temporal antialiasing.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "capture/capture.h"
#include "raster/depth_buffer.h"
#include "raster/draw_pass.h"
#include "raster/pipeline.h"
#include "raster/textures.h"
#include "sample/pellucid_pass.h"
#include "sample/scene.h"
#include "sample/uniforms.h"

namespace pellucid::sample {

// What an integration may get wrong, to see it; docs/integration.md has the pictures. The shaders know the
// numbers.
enum class Mistake : std::uint32_t {
  None,
  FrontsUnsaid,
  BiasUnsaid,
  Units,
  Gamma,
  AlbedoTwice,
  SpecularDiffused
};
inline const std::vector<std::string> kMistakeNames = {"none",  "culled-fronts", "depth-bias",       "units",
                                                       "gamma", "albedo-twice",  "specular-diffused"};

struct Settings {
  bool pellucid = true;
  std::uint32_t quality = 1;  // of Pellucid, 0..2
  bool sun = true, spots = true, point = true, ambient = true, specular = true, taa = true;
  double scale = 1;                       // of the rendered rect to the picture along each side, (0, 1]
  bool cullFronts = false;                // of the spots' shadow maps
  float biasConstant = 0, biasSlope = 0;  // of the spots' shadow maps, as factors away from the light, >= 0
  float exposure = 1;
  Mistake mistake = Mistake::None;
};

class Renderer {
public:
  // mapTexels: across a shadow map. The scene must outlive it.
  Renderer(Device& device, const Scene& scene, VkExtent2D extent, std::uint32_t mapTexels);
  ~Renderer();

  // Submits the next frame, after the frame that was submitted kFramesInFlight before has finished.
  void draw(const Settings& settings, const ViewCamera& camera);

  // ---- Of the last frame; they wait for it.
  const GpuImage& picture() const;  // what a display shows, RGBA8 in the layout GENERAL
  Image color() const;              // linear, after Pellucid and before antialiasing; of the rect, RGB
  Image irradiance() const;         // as stored; likewise
  // What Pellucid read, and as the truth what it added, free of exposure.
  Capture capture();

private:
  struct Slot {
    VkCommandBuffer commands;
    std::unique_ptr<Owned<VkFence, vkDestroyFence>> done;
  };
  struct Bound {
    PellucidImage image;
    VkSampler sampler;
  };

  void createPasses();
  void createSlots();
  void makeFrame(const ViewCamera& camera);
  Uniforms uniforms(const ViewCamera& camera) const;
  PellucidImage transient(std::uint32_t slot, const PellucidImageNeed& need);
  VkPipeline meshPipeline(const DrawPass& pass, VkCullModeFlags cull);
  void drawScene(VkCommandBuffer commands, const DrawPass& pass, const glm::dmat4& clipFromWorld,
                 VkCullModeFlags cull);
  void drawShadows(VkCommandBuffer commands);
  void drawGbuffer(VkCommandBuffer commands);
  void light(VkCommandBuffer commands);
  void resolve(VkCommandBuffer commands);
  void bind(VkCommandBuffer commands, const std::vector<Bound>& images) const;
  void drawScreen(VkCommandBuffer commands, const DrawPass& pass, VkExtent2D extent, VkPipeline pipeline,
                  const std::vector<Bound>& images) const;
  int width() const { return static_cast<int>(extent_.width); }
  int height() const { return static_cast<int>(extent_.height); }
  int maps(std::uint32_t count) const { return static_cast<int>(count * mapTexels_); }
  VkSampler nearest() const { return textures_.sampler(textures_.white()); }
  void wait() const;
  Image rectOf(const Image& image) const;

  Device& device_;
  const Scene& scene_;
  VkExtent2D extent_;
  std::uint32_t mapTexels_;
  HostBuffer vertices_, indices_;
  UploadedTextures textures_;
  GpuImage normal_, albedo_, surface_, irradiance_, color_, picture_;
  std::array<std::unique_ptr<GpuImage>, 2> history_;
  DepthBuffer depth_, backDepth_;
  std::array<DepthBuffer, kShadowImages> shadows_;
  // By slot, format and extent.
  std::map<std::tuple<std::uint32_t, VkFormat, std::uint32_t, std::uint32_t>, std::unique_ptr<GpuImage>>
      transients_;
  std::unique_ptr<DrawPass> gbufferPass_, backPass_, lightingPass_;
  std::array<std::unique_ptr<DrawPass>, 2> resolvePass_;
  std::array<std::vector<std::unique_ptr<DrawPass>>, kShadowImages> shadowPasses_;  // one a layer
  PushLayout layout_;
  std::map<std::tuple<VkFormat, std::size_t, VkCullModeFlags>, Pipeline> meshPipelines_;
  Pipeline lighting_, resolve_;
  Owned<VkSampler, vkDestroySampler> linear_, compare_;
  Owned<VkCommandPool, vkDestroyCommandPool> pool_;
  std::array<Slot, kFramesInFlight> slots_;
  HostBuffer uniforms_;
  PellucidPass pellucid_;
  Settings settings_;
  Frame frame_;  // the last one
  std::uint64_t next_ = 0;
  glm::dvec2 jitter_{0};                 // pixels of the rect
  glm::dmat4 previous_{1}, current_{1};  // clipFromWorld without jitter, of the frame before and of this one
};

}  // namespace pellucid::sample
