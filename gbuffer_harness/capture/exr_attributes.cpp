#include "capture/exr_attributes.h"

#include <ImfChromaticities.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace pellucid::harness {

namespace {

constexpr AttributeUse kUsed = AttributeUse::Used, kNoEffect = AttributeUse::NoEffect,
                       kNamed = AttributeUse::Named, kRefused = AttributeUse::Refused;

// Three decimals are what programs write; ACES' red differs from Rec. 709's by .07.
constexpr float kSamePoint = 0.002f;

constexpr const char* kAdvice = "; they are read as they are: convert them to linear Rec. 709";

std::string otherPrimaries(const Imf::Chromaticities& found) {
  const Imf::Chromaticities rec709;
  const struct {
    const char* name;
    Imath::V2f found, wanted;
  } points[] = {{"red", found.red, rec709.red},
                {"green", found.green, rec709.green},
                {"blue", found.blue, rec709.blue},
                {"white", found.white, rec709.white}};
  for (const auto& point : points) {
    if ((point.found - point.wanted).length() <= kSamePoint) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "chromaticities: %s of its colors is at (%.4g, %.4g), not at Rec. 709's (%.4g, %.4g)",
                  point.name, double(point.found.x), double(point.found.y), double(point.wanted.x),
                  double(point.wanted.y));
    return std::string(text) + kAdvice;
  }
  return "";
}

// Names that OpenImageIO, OpenColorIO and Blender have for linear colors of Rec. 709, and for data.
bool keepsRec709(std::string name) {
  std::erase_if(name, [](unsigned char c) { return !std::isalnum(c); });
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  const char* const known[] = {"",
                               "data",
                               "linear",
                               "scenelinear",
                               "raw",
                               "unknown",
                               "linrec709",
                               "linrec709scene",
                               "linsrgb",
                               "linearrec709",
                               "linearrec709srgb",
                               "linearsrgb",
                               "linearbt709",
                               "utilitylinearsrgb",
                               "utilityraw",
                               "noncolor"};
  return std::find(std::begin(known), std::end(known), name) != std::end(known);
}

}  // namespace

const std::vector<ExrAttribute>& exrAttributes() {
  static const std::vector<ExrAttribute> attributes = {{"channels", kUsed},
                                                       {"compression", kUsed},
                                                       {"dataWindow", kUsed},
                                                       {"displayWindow", kUsed},
                                                       {"lineOrder", kUsed},
                                                       {"tiles", kUsed},
                                                       {"name", kUsed},
                                                       {"type", kUsed},
                                                       {"chunkCount", kUsed},
                                                       {"version", kUsed},
                                                       {"view", kUsed},
                                                       {"multiView", kUsed},
                                                       {"pixelAspectRatio", kUsed},
                                                       {"screenWindowCenter", kUsed},
                                                       {"screenWindowWidth", kUsed},
                                                       {"worldToCamera", kUsed},
                                                       {"worldToNDC", kUsed},
                                                       {"dwaCompressionLevel", kNoEffect},
                                                       {"chromaticities", kNamed},
                                                       {"colorInteropID", kNamed},
                                                       {"oiio:ColorSpace", kNamed},
                                                       {"envmap", kRefused},
                                                       {"deepImageState", kRefused},
                                                       {"maxSamplesPerPixel", kRefused},
                                                       {"adoptedNeutral", kNoEffect},
                                                       {"whiteLuminance", kNoEffect},
                                                       {"renderingTransform", kNoEffect},
                                                       {"lookModTransform", kNoEffect},
                                                       {"preview", kNoEffect},
                                                       {"originalDataWindow", kNoEffect},
                                                       {"wrapmodes", kNoEffect},
                                                       {"owner", kNoEffect},
                                                       {"comments", kNoEffect},
                                                       {"capDate", kNoEffect},
                                                       {"utcOffset", kNoEffect},
                                                       {"longitude", kNoEffect},
                                                       {"latitude", kNoEffect},
                                                       {"altitude", kNoEffect},
                                                       {"focus", kNoEffect},
                                                       {"expTime", kNoEffect},
                                                       {"aperture", kNoEffect},
                                                       {"isoSpeed", kNoEffect},
                                                       {"keyCode", kNoEffect},
                                                       {"timeCode", kNoEffect},
                                                       {"framesPerSecond", kNoEffect},
                                                       {"xDensity", kNoEffect},
                                                       {"imageCounter", kNoEffect},
                                                       {"reelName", kNoEffect},
                                                       {"cameraColorBalance", kNoEffect},
                                                       {"shutterAngle", kNoEffect},
                                                       {"nominalFocalLength", kNoEffect},
                                                       {"pinholeFocalLength", kNoEffect},
                                                       {"effectiveFocalLength", kNoEffect},
                                                       {"tStop", kNoEffect}};
  return attributes;
}

std::vector<std::string> unusedAttributes(const Imf::Header& header) {
  std::vector<std::string> sentences;
  for (const ExrAttribute& attribute : exrAttributes()) {
    if (attribute.use != AttributeUse::Named) continue;
    if (const auto* points = header.findTypedAttribute<Imf::ChromaticitiesAttribute>(attribute.name)) {
      if (std::string sentence = otherPrimaries(points->value()); !sentence.empty())
        sentences.push_back(std::move(sentence));
    } else if (const auto* space = header.findTypedAttribute<Imf::StringAttribute>(attribute.name);
               space && !keepsRec709(space->value())) {
      sentences.push_back(std::string(attribute.name) + ": its colors are \"" + space->value() + "\"" +
                          kAdvice);
    }
  }
  return sentences;
}

}  // namespace pellucid::harness
