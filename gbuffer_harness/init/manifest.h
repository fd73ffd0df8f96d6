// A manifest for EXR files of another program, with what it could not know said in it.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "init/camera.h"
#include "init/guess.h"

namespace pellucid::harness {

struct InitWords {
  CameraWords camera;
  std::map<Role, std::string> roles;
  std::optional<bool> deviceDepth;
  std::optional<double> irradianceScale, metersPerUnit;
  std::vector<int> materialIds;                // stored values that are translucent; empty: all but 0
  std::string material = "skin1";              // of parseMaterial()
  std::vector<nlohmann::ordered_json> lights;  // as in a manifest
};

struct GuessedManifest {
  nlohmann::ordered_json json;       // keys that begin with // are sentences for a person
  std::vector<std::string> found;    // a line for each buffer: what it is and why
  std::vector<std::string> missing;  // what would make the picture better, the most important first
};

// Paths in the manifest are relative to `folder`. Throws UsageError where words are missing, and InputError
// for files that cannot be a capture: without a depth or a color, or of several sizes.
GuessedManifest guessManifest(const std::vector<std::filesystem::path>& files,
                              const std::filesystem::path& folder, const InitWords& words);

}  // namespace pellucid::harness
