// How a capture is run, and the table of its settings: `--set`, JSON files, the viewer's panel
// and the frame read the same rows. A new setting is a member here and a row of settings.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/translucency_settings.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

// Which T(d) stands for the material's own.
enum class TransmittanceChoice {
  Material,
  Linear,  // 1 - d/dmax with the dmax that is nearest to the material's own T over 0..10 mm
  Gaussians,
  GaussiansAsPrinted
};

struct ReplaySettings {
  uint32_t features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  TranslucencySettings translucency;
  TransmittanceChoice transmittance = TransmittanceChoice::Material;
  PellucidDebugView debugView = PELLUCID_DEBUG_NONE;
  VkFormat outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  VkFormat irradianceFormat = VK_FORMAT_UNDEFINED;  // UNDEFINED: outputFormat
  // See PellucidFrame. With a mask, the other bits of the 32 of the uploaded material image hold noise.
  uint32_t materialShift = 0, materialMask = 0;
  // Light from all around comes through thin parts; not given: where the capture has hidden irradiance.
  std::optional<bool> ambient;
  bool addToOutput = false;  // FrameRun::uploadOutput says to what
  // The uploaded irradiance is the capture's times this. 0: of Replayer::run preExposureFor() the capture, by
  // which its output is divided again; elsewhere 1.
  float preExposure = 1;
  PellucidReuse reuse = PELLUCID_REUSE_NONE;
  float coherenceThreshold = 0.005f;
  std::array<float, 4> anchor = {0, 0, 0, 0};
  bool aliasOutput = false;  // see inPlace()
  bool indirectDispatches = true;
  std::array<uint32_t, 4> renderRect = {0, 0, 0, 0};  // width 0: everything

  // The output is the irradiance image, which debug views never replace.
  bool inPlace() const { return aliasOutput && debugView == PELLUCID_DEBUG_NONE; }
};

// Whelan 2009: linear transmittance, camera-space thickness along the view ray, the inverse cosine of the
// angle between camera and light, rejection by the shadow map.
ReplaySettings thesisSettings();

struct Setting {
  enum class Kind {
    Choice,  // the value is an index into `names`
    Bits,    // bit i of the value is names[i]
    Whole,   // 0..2^32 - 1
    Real     // finite floats
  };
  using Values = std::vector<double>;

  std::string key;
  std::string help;  // a sentence with the unit, and with the default where it is not 0 or the first name
  Kind kind = Kind::Real;
  std::vector<std::string> names;
  std::map<std::string, Values> named = {};  // words that stand for numbers
  bool anyCount = false;                     // of values; else the count that `get` returns

  // The panel's part. An empty label: the panel does not offer the setting.
  std::string group, label = {};  // the label has the unit
  double low = 0, high = 1;       // ends of a slider, and the last of `names` that the panel offers
  double step = 1;                // of Whole: values are multiples of it

  std::function<Values(const ReplaySettings&)> get;
  std::function<void(ReplaySettings&, const Values&)> set;
  std::function<void(const ReplaySettings&, PellucidFrameOptions&, PellucidThesisOptions&)> toFrame =
      {};                                                     // empty: makeFrame() does it
  std::function<bool(const ReplaySettings&)> hasEffect = {};  // with the other settings; empty: always
};

const std::vector<Setting>& settingsTable();

// Throws UsageError, which begins with `where` and lists the keys.
const Setting& findSetting(const std::string& where, const std::string& key);

// "key=" and what may stand there, for --help.
std::string syntaxOf(const Setting& setting);

// The values that `text` means: a name, or numbers with commas. Throws UsageError, which begins with `where`.
Setting::Values parseValues(const Setting& setting, const std::string& where, const std::string& text);

// Names of a Choice's or Bits' value with commas; "none" without a bit, and "" for a value without a name.
std::string namesOf(const Setting& setting, const Setting::Values& values);

// Sets the nearest values that the panel allows; NaN leaves a value as it is.
void assignNearest(const Setting& setting, ReplaySettings& settings, Setting::Values values);

// Every setting of the table that is a field of the frame's options.
void setOptions(const ReplaySettings& settings, PellucidFrameOptions& options, PellucidThesisOptions& thesis);

}  // namespace pellucid::harness
