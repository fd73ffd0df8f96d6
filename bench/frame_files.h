// Libraries beside the executable read files and are loaded when a file is asked for: the executable
// runs where OpenEXR and tinygltf are not installed.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "capture/capture.h"
#include "raster/model.h"

namespace pellucid::bench {

// Each library has one C function of that name, which may throw InputError.
using ReadCaptureFile = void(const std::filesystem::path& file, harness::Capture& capture);
inline constexpr const char kCaptureLibrary[] = "pellucid_bench_captures.so",
                            kReadCaptureFile[] = "pellucidBenchReadCapture";

struct ModelFile {
  std::filesystem::path path;
  double metersPerUnit;
  std::map<std::string, std::string> presets;  // as GltfOptions has them
};
using ReadModelFile = void(const ModelFile& file, harness::Model& model);
inline constexpr const char kModelLibrary[] = "pellucid_bench_models.so",
                            kReadModelFile[] = "pellucidBenchReadModel";

// Throws InputError naming the library if it is not there or cannot be loaded.
harness::Capture readCaptureFile(const std::filesystem::path& file);
harness::Model readModelFile(const ModelFile& file);

}  // namespace pellucid::bench
