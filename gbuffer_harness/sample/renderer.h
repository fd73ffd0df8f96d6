// A deferred renderer: shadow maps, G-buffer, lighting, Pellucid, temporal antialiasing.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>

#include "capture/capture.h"
#include "common/barrier.h"
#include "common/pool.h"
#include "raster/render_target.h"
#include "raster/draw.h"
#include "sample/pellucid_pass.h"
#include "sample/scene.h"
#include "sample/submissions.h"

namespace pellucid::sample {

// Mistakes that an integration may make, to see them: docs/integration.md. The shaders know the numbers.
enum class Mistake : std::uint32_t { None, Fronts, Bias, Units, Gamma, AlbedoTwice, SpecularDiffused };
inline const std::vector<std::string> kMistakes = {"none",  "culled-fronts", "depth-bias",       "units",
                                                   "gamma", "albedo-twice",  "specular-diffused"};

// The layout of depth buffers that shaders read; other images are in GENERAL throughout.
constexpr VkImageLayout kDepthRead = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;

struct Settings {
  bool pellucid = true;
  std::uint32_t gatherSamples = 8;  // of Pellucid
  bool ownQueue = false;            // Pellucid runs on the device's computeQueue(), between semaphores
  bool sun = true, spots = true, point = true, ambient = true, specular = true, taa = true;
  double scale = 1;                       // of the rendered rect to the picture along each side, (0, 1]
  bool cullFronts = false;                // of the spots' shadow maps
  bool fronts = false;                    // with cullFronts: maps of front faces besides, for Pellucid
  float biasConstant = 4, biasSlope = 3;  // depth bias of all shadow maps, away from the light, >= 0
  float exposure = 1;
  Mistake mistake = Mistake::None;
};

class Renderer {
public:
  // mapTexels: across a shadow map, as the scene's. The scene must outlive it.
  Renderer(Device& device, const Scene& scene, VkExtent2D extent, std::uint32_t mapTexels);
  ~Renderer() { vkDeviceWaitIdle(device_.handle()); }

  // Makes the images of the screen anew. Pellucid keeps nothing of the old size.
  void resize(VkExtent2D extent);

  // Submits the next frame, once the frame kFramesInFlight before has finished.
  void draw(const Settings& settings, const ViewCamera& camera);

  // ---- Of the last frame; they wait for it.
  const GpuImage& picture() const;  // what a display shows, RGBA8 in the layout GENERAL
  Image color() const;              // linear, after Pellucid and before antialiasing; of the rect, RGB
  Image irradiance() const;         // as stored; likewise
  Capture capture();                // what Pellucid read, and as the truth what it added, free of exposure

private:
  // Two histories in turns.
  enum Target { kNormal, kAlbedo, kSurface, kIrradiance, kColor, kHistory, kPicture = 7, kTargets };
  struct Bound {
    PellucidImage image;
    VkSampler sampler;
  };

  std::unique_ptr<DrawPass> passTo(VkExtent2D extent, const std::vector<int>& colors, VkImageView depth,
                                   VkFormat depthFormat) const;
  void createPipelines();
  void makeFrame(const ViewCamera& camera);
  void addLight(const SceneLight& light, const std::vector<LightView>& views);
  void writeUniforms(const ViewCamera& camera) const;
  VkPipeline meshPipeline(const DrawPass& pass, VkCullModeFlags cull);
  void drawScene(VkCommandBuffer commands, const DrawPass& pass, const glm::dmat4& clipFromWorld,
                 VkCullModeFlags cull);
  void drawShadows(VkCommandBuffer commands);
  void drawGbuffer(VkCommandBuffer commands);
  void light(VkCommandBuffer commands) const;
  void resolve(VkCommandBuffer commands) const;
  void bind(VkCommandBuffer commands, std::span<const Bound> images) const;
  void drawScreen(VkCommandBuffer commands, const DrawPass& pass, VkExtent2D extent, VkPipeline pipeline,
                  std::span<const Bound> images) const;
  VkSampler nearest() const { return mesh_.sampler(mesh_.white()); }
  Image rectOf(const Image& image) const;

  Device& device_;
  const Scene& scene_;
  VkExtent2D extent_;
  std::uint32_t mapTexels_;
  UploadedMesh mesh_;
  std::array<std::unique_ptr<GpuImage>, kTargets> targets_;
  std::optional<DepthBuffer> depth_, backDepth_;
  std::array<DepthBuffer, kShadowImages> shadows_;
  ImagePool pool_;
  std::vector<std::shared_ptr<GpuImage>> transients_;  // of the last frame
  std::unique_ptr<DrawPass> gbufferPass_, backPass_, lightingPass_, resolvePasses_[2];
  std::vector<std::unique_ptr<DrawPass>> shadowPasses_[kShadowImages];  // one a layer
  PushLayout layout_;
  std::map<std::tuple<VkFormat, std::size_t, VkCullModeFlags>, Pipeline> meshPipelines_;
  Pipeline lighting_, resolve_;
  Owned<VkSampler, vkDestroySampler> linear_, compare_;
  Submissions submissions_;
  HostBuffer uniforms_;
  PellucidPass pellucid_;
  HostBuffer constants_;  // of Pellucid, a slice for each frame in flight
  Settings settings_;
  Frame frame_;                    // the last one
  std::vector<const Light*> lit_;  // its lights
  std::uint64_t next_ = 0, resized_ = 0;  // frames; resized_: the first of these images
  glm::dvec2 jitter_{0};                 // pixels of the rect
  glm::dmat4 previous_{1}, current_{1};  // clipFromWorld without jitter, of the frame before and of this one
};

}  // namespace pellucid::sample
