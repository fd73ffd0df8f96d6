#include "replay/settings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {
namespace {

using Kind = Setting::Kind;
using Values = Setting::Values;

template <class T>
Values valuesOf(const T& field) {
  return {static_cast<double>(field)};
}
template <class T, std::size_t N>
Values valuesOf(const std::array<T, N>& field) {
  return Values(field.begin(), field.end());
}
Values valuesOf(const std::vector<float>& field) { return Values(field.begin(), field.end()); }

template <class T>
void store(const Values& from, T& field) {
  field = static_cast<T>(from[0]);
}
template <class T, std::size_t N>
void store(const Values& from, std::array<T, N>& field) {
  std::transform(from.begin(), from.end(), field.begin(), [](double v) { return static_cast<T>(v); });
}
template <class T, std::size_t N>
void store(const Values& from, T (&field)[N]) {
  std::transform(from.begin(), from.end(), field, [](double v) { return static_cast<T>(v); });
}
void store(const Values& from, std::vector<float>& field) {
  field.resize(from.size());
  std::transform(from.begin(), from.end(), field.begin(), [](double v) { return static_cast<float>(v); });
}

// A member of any ReplaySettings, const or not; of the frame's options; of the thesis's options.
#define FIELD(member) \
  [](auto& settings) -> auto& { return settings.member; }
#define OPTION(member) \
  [](PellucidFrameOptions & options, PellucidThesisOptions&) -> auto& { return options.member; }
#define THESIS(member) \
  [](PellucidFrameOptions&, PellucidThesisOptions & options) -> auto& { return options.member; }

struct Row : Setting {
  std::function<Values(const ReplaySettings&)> stored;  // the field itself, also where `get` is an index

  template <class Option>
  Row& frame(Option option) {
    toFrame = [option, field = stored](const ReplaySettings& s, PellucidFrameOptions& o,
                                       PellucidThesisOptions& t) { store(field(s), option(o, t)); };
    return *this;
  }
  Row& panel(const char* panelGroup, const char* panelLabel) {
    group = panelGroup;
    label = panelLabel;
    return *this;
  }
  Row& range(double least, double most, double steps = 1) {
    low = least;
    high = most;
    step = steps;
    return *this;
  }
  Row& where(std::function<bool(const ReplaySettings&)> condition) {
    hasEffect = std::move(condition);
    return *this;
  }
};

template <class Field>
Row numbers(Kind kind, const char* key, const char* help, Field field) {
  Row row;
  row.key = key;
  row.help = help;
  row.kind = kind;
  row.stored = row.get = [field](const ReplaySettings& s) { return valuesOf(field(s)); };
  row.set = [field](ReplaySettings& s, const Values& v) { store(v, field(s)); };
  return row;
}
template <class Field>
Row real(const char* key, const char* help, Field field) {
  return numbers(Kind::Real, key, help, field);
}
template <class Field>
Row whole(const char* key, const char* help, Field field) {
  return numbers(Kind::Whole, key, help, field);
}

template <class T, class Field>
Row choice(const char* key, const char* help, Field field,
           const std::vector<std::pair<const char*, T>>& choices) {
  Row row;
  row.key = key;
  row.help = help;
  row.kind = Kind::Choice;
  std::vector<T> values;
  for (const auto& [name, value] : choices) {
    row.names.emplace_back(name);
    values.push_back(value);
  }
  row.high = static_cast<double>(values.size() - 1);
  row.get = [field, values](const ReplaySettings& s) {
    return valuesOf(std::find(values.begin(), values.end(), field(s)) - values.begin());
  };
  row.set = [field, values](ReplaySettings& s, const Values& v) {
    field(s) = values[static_cast<std::size_t>(v[0])];
  };
  if constexpr (requires(T value) { static_cast<double>(value); })
    row.stored = [field](const ReplaySettings& s) { return valuesOf(field(s)); };
  return row;
}
template <class Field>
Row flag(const char* key, const char* help, Field field) {
  return choice<bool>(key, help, field, {{"0", false}, {"1", true}});
}

bool hasTranslucency(const ReplaySettings& s) { return s.features & PELLUCID_FEATURE_TRANSLUCENCY; }
// Further settings of the frame may keep light from being gathered; the plan's skips say so.
bool gathers(const ReplaySettings& s) {
  return hasTranslucency(s) && s.features & PELLUCID_FEATURE_DIFFUSION && !s.translucency.cameraThickness;
}
bool oneThickness(const ReplaySettings& s) {
  return hasTranslucency(s) && (s.translucency.gatherSamples == 0 || !gathers(s));
}
bool angleIs(const ReplaySettings& s, PellucidAngleModel model) {
  return oneThickness(s) && s.translucency.angleModel == model;
}

Row features() {
  Row row = numbers(Kind::Bits, "features", "what runs; default both", FIELD(features));
  row.names = {"translucency", "diffusion"};
  static_assert(PELLUCID_FEATURE_TRANSLUCENCY == 1 && PELLUCID_FEATURE_DIFFUSION == 2);
  return row.range(0, 3);
}

Row polynomial() {
  Row row = real("polynomial",
                 "c0 + c1 a + c2 a^2 + c3 a^3 of angle=polynomial, a in radians between camera and light, or "
                 "quadratic|cubic of the thesis; default linear",
                 FIELD(translucency.anglePolynomial));
  // Whelan 2009, eqs. 4.4 and 4.5.
  row.named = {{"quadratic", {2.14506, -2.27844, 0.595752, 0}},
               {"cubic", {-5.07621, 7.75534, -3.9017, 0.650897}}};
  return row.range(-10, 10).where([](const auto& s) { return angleIs(s, PELLUCID_ANGLE_POLYNOMIAL); });
}

Row minimumDots() {
  Row row =
      real("minimum-dots", "of angle=minimum-dot-azimuth (thesis: 36) or -sphere (rows of a square), -1..0",
           FIELD(translucency.minimumDotTable));
  row.anyCount = true;
  return row;
}

std::vector<Setting> makeTable() {
  const char *const quality = "Quality", *const thickness = "Thickness and transmittance",
                    *const angle = "Angle between view and light", *const reuse = "Reuse between frames";
  return {
      features().panel(quality, "features").frame(OPTION(features)),
      whole("gather",
            "samples of the shadow map for each probe, a multiple of 4, 0..64; default 8, 0: one thickness a "
            "pixel",
            FIELD(translucency.gatherSamples))
          .panel(quality, "samples")
          .range(0, 64, 4)
          .where(gathers)
          .frame(OPTION(gatherSamples)),
      choice<uint32_t>("gather-spacing",
                       "pixels a side that one probe stands for; 0 (default): by the image's size",
                       FIELD(translucency.gatherSpacing), {{"0", 0}, {"1", 1}, {"2", 2}, {"4", 4}})
          .panel(quality, "probe spacing")
          .where(gathers)
          .frame(OPTION(gatherSpacing)),
      choice<bool>("indirect", "passes run everywhere, or (default) where the GPU finds material",
                   FIELD(indirectDispatches), {{"none", false}, {"material", true}})
          .panel(quality, "indirect")
          .frame(OPTION(indirectDispatches)),
      choice<bool>("thickness", "where thickness comes from for lights with a shadow map",
                   FIELD(translucency.cameraThickness), {{"light", false}, {"camera", true}})
          .panel(thickness, "thickness")
          .where(hasTranslucency)
          .frame(OPTION(cameraThickness)),
      choice<TransmittanceChoice>("transmittance", "which T(d) stands for the material's own",
                                  FIELD(transmittance),
                                  {{"material", TransmittanceChoice::Material},
                                   {"linear", TransmittanceChoice::Linear},
                                   {"gaussians", TransmittanceChoice::Gaussians},
                                   {"gaussians-as-printed", TransmittanceChoice::GaussiansAsPrinted}})
          .panel(thickness, "T(d)")
          .where(hasTranslucency),
      real("max-thickness", "mm, beyond which nothing comes through; 0 (default): no limit",
           FIELD(translucency.maximumThickness))
          .panel(thickness, "largest thickness, mm")
          .range(0, 100)
          .where(hasTranslucency)
          .frame(THESIS(maximumThickness)),
      real("filter", "r,g,b that multiply T, 0..1 (thesis: .55,.29,.28); default 1",
           FIELD(translucency.transmittanceFilter))
          .panel(thickness, "filter")
          .where(hasTranslucency)
          .frame(THESIS(transmittanceFilter)),
      flag("chord", "camera thickness without the cosine correction", FIELD(translucency.chordThickness))
          .panel(thickness, "chord")
          .where([](const auto& s) { return hasTranslucency(s) && s.translucency.cameraThickness; })
          .frame(THESIS(chordThickness)),
      // The panel offers no model that needs a table, which sliders cannot make.
      choice<PellucidAngleModel>("angle", "the cosine of the light on the hidden face",
                                 FIELD(translucency.angleModel),
                                 {{"normal", PELLUCID_ANGLE_NORMAL},
                                  {"cosine", PELLUCID_ANGLE_COSINE},
                                  {"inverse-cosine", PELLUCID_ANGLE_INVERSE_COSINE},
                                  {"polynomial", PELLUCID_ANGLE_POLYNOMIAL},
                                  {"minimum-dot", PELLUCID_ANGLE_MINIMUM_DOT},
                                  {"minimum-dot-azimuth", kMinimumDotAzimuth},
                                  {"minimum-dot-sphere", kMinimumDotSphere}})
          .panel(angle, "model")
          .range(0, 4)
          .where(oneThickness),
      polynomial().panel(angle, "c0 c1 c2 c3").frame(THESIS(anglePolynomial)),
      real("minimum-dot",
           "cosine above which nothing comes through, of angle=minimum-dot and prescale=1, -1..0",
           FIELD(translucency.minimumDot))
          .panel(angle, "minimum dot")
          .range(-1, 0)
          .where([](const auto& s) {
            return angleIs(s, PELLUCID_ANGLE_MINIMUM_DOT) ||
                   (oneThickness(s) && s.translucency.prescaleAngle);
          }),
      minimumDots(),
      flag("prescale", "cosine, inverse-cosine and polynomial begin at minimum-dot",
           FIELD(translucency.prescaleAngle))
          .panel(angle, "pre-scaled")
          .where(oneThickness)
          .frame(THESIS(prescaleAngle)),
      choice<bool>("view",
                   "the view ray of the angle: each pixel's, or the camera's axis as the thesis has it",
                   FIELD(translucency.constantViewDirection), {{"pixel", false}, {"constant", true}})
          .panel(angle, "view ray")
          .where(oneThickness)
          .frame(THESIS(constantViewDirection)),
      real("face", "x,y,z the object looks along, world; default 0,0,1", FIELD(translucency.faceVector)),
      real("up", "x,y,z of the object, world; default 0,1,0", FIELD(translucency.upAxis)),
      real("center", "x,y,z of the object, world", FIELD(translucency.objectCenter)),
      whole("mark-bit", "of material values without translucency, a power of two; 0 (default): none",
            FIELD(translucency.materialMarkBit))
          .frame(THESIS(materialMarkBit)),
      choice<PellucidReuse>("reuse",
                            "light that came through is taken from the frame before; a single frame always "
                            "computes it",
                            FIELD(reuse),
                            {{"none", PELLUCID_REUSE_NONE},
                             {"alternate", PELLUCID_REUSE_ALTERNATE},
                             {"coherence", PELLUCID_REUSE_COHERENCE},
                             {"accumulate", PELLUCID_REUSE_ACCUMULATE}})
          .panel(reuse, "reuse")
          .range(0, 2)  // the viewer has no motion vectors
          .frame(OPTION(reuse)),
      real("coherence-threshold", "change of the cosine between camera and light, 0..2; default .005",
           FIELD(coherenceThreshold))
          .panel(reuse, "threshold")
          .range(0, 0.1f)
          .where([](const auto& s) { return s.reuse == PELLUCID_REUSE_COHERENCE; })
          .frame(OPTION(coherenceThreshold)),
      real("anchor",
           "x,y,z,1: point that cells and patterns of samples follow on the screen, world; w 0 (default): none",
           FIELD(anchor))
          .frame(OPTION(anchor)),
      choice<VkFormat>("format", "of the output", FIELD(outputFormat),
                       {{"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT},
                        {"rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT},
                        {"rg11b10f", VK_FORMAT_B10G11R11_UFLOAT_PACK32}})
          .frame(OPTION(outputFormat)),
      choice<std::optional<bool>>("ambient",
                                  "light from all around comes through thin parts; auto (default): where the "
                                  "capture has hidden irradiance",
                                  FIELD(ambient), {{"0", false}, {"1", true}, {"auto", std::nullopt}}),
      flag("alias", "output is the irradiance image", FIELD(aliasOutput)),
      whole("rect", "x,y,width,height in pixels; width 0 (default): everything", FIELD(renderRect))
          .frame(OPTION(renderRect)),
  };
}

std::string listed(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

std::size_t indexOf(const std::vector<std::string>& names, const std::string& where,
                    const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw UsageError(where + ": \"" + name + "\" is not one of " + listed(names));
  return static_cast<std::size_t>(found - names.begin());
}

template <class T>
double number(const std::string& where, const std::string& text, const char* what) {
  const std::optional<T> value = numberIn<T>(text);
  if (!value) throw UsageError(where + ": \"" + text + "\" is not " + what);
  return static_cast<double>(*value);
}

}  // namespace

ReplaySettings thesisSettings() {
  ReplaySettings s;
  s.transmittance = TransmittanceChoice::Linear;
  s.translucency.cameraThickness = true;
  s.translucency.angleModel = PELLUCID_ANGLE_INVERSE_COSINE;
  s.translucency.chordThickness = true;
  return s;
}

const std::vector<Setting>& settingsTable() {
  static const std::vector<Setting> table = makeTable();
  return table;
}

const Setting& findSetting(const std::string& where, const std::string& key) {
  std::vector<std::string> keys;
  for (const Setting& setting : settingsTable()) {
    if (setting.key == key) return setting;
    keys.push_back(setting.key);
  }
  throw UsageError(where + ": unknown key \"" + key + "\"; there are " + listed(keys));
}

std::string syntaxOf(const Setting& setting) {
  std::string names;
  for (const std::string& name : setting.names) names += (names.empty() ? "" : "|") + name;
  return setting.key + "=" + names + (setting.names.empty() ? "" : ": ") + setting.help;
}

Setting::Values parseValues(const Setting& setting, const std::string& where, const std::string& text) {
  switch (setting.kind) {
    case Kind::Choice:
      return valuesOf(indexOf(setting.names, where, text));
    case Kind::Bits: {
      std::vector<std::string> names = setting.names;
      names.emplace_back("none");
      std::size_t bits = 0;
      for (const std::string& name : split(text, ',')) bits |= std::size_t{1} << indexOf(names, where, name);
      return valuesOf(bits & ((std::size_t{1} << setting.names.size()) - 1));
    }
    case Kind::Whole:
    case Kind::Real:
      break;
  }
  if (!setting.named.empty() && text.find_first_of(",0123456789") == std::string::npos) {
    std::vector<std::string> words;
    for (const auto& [word, unused] : setting.named) words.push_back(word);
    return setting.named.at(words[indexOf(words, where, text)]);
  }
  const std::size_t count = setting.get(ReplaySettings()).size();
  const std::vector<std::string> parts =
      setting.anyCount || count > 1 ? split(text, ',') : std::vector<std::string>{text};
  if (!setting.anyCount && parts.size() != count)
    throw UsageError(where + ": \"" + text + "\" is not " + std::to_string(count) + " numbers with commas");
  Values values;
  for (const std::string& part : parts)
    values.push_back(setting.kind == Kind::Whole ? number<std::uint32_t>(where, part, "a whole number")
                                                 : number<float>(where, part, "a number"));
  return values;
}

std::string namesOf(const Setting& setting, const Values& values) {
  const auto value = static_cast<std::size_t>(values[0]);
  if (setting.kind == Kind::Choice) return value < setting.names.size() ? setting.names[value] : "";
  std::string all;
  for (std::size_t i = 0; i < setting.names.size(); ++i)
    if (value >> i & 1) all += (all.empty() ? "" : ",") + setting.names[i];
  return all.empty() ? "none" : all;
}

void assignNearest(const Setting& setting, ReplaySettings& settings, Values values) {
  const Values before = setting.get(settings);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) values[i] = before[i];
    values[i] = std::clamp(values[i], setting.low, setting.high);
    if (setting.kind != Kind::Real) values[i] = setting.step * std::round(values[i] / setting.step);
  }
  setting.set(settings, values);
}

void setOptions(const ReplaySettings& settings, PellucidFrameOptions& options,
                PellucidThesisOptions& thesis) {
  for (const Setting& setting : settingsTable())
    if (setting.toFrame) setting.toFrame(settings, options, thesis);
}

}  // namespace pellucid::harness
