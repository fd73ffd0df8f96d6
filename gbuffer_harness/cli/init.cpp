// `pellucid init`: a manifest for EXR files of other programs.
#include <cstdio>
#include <memory>

#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/numbers.h"
#include "common/error.h"
#include "common/whole_file.h"
#include "init/manifest.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLightWords = "directional:X,Y,Z[:E] (direction of travel) or point:X,Y,Z:I";

struct Options {
  std::vector<std::string> files, lights;
  std::string output = "capture.json", unit, depth, eye, target, up;
  InitWords words;
  std::map<Role, std::string> roles;
  bool overwrite = false;
};

Json lightOf(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  const bool isPoint = parts[0] == "point";
  if ((!isPoint && parts[0] != "directional") || parts.size() < (isPoint ? 3 : 2) || parts.size() > 3)
    throw UsageError("--light: \"" + text + "\" is not " + kLightWords);
  const Vector3 where = parseNumbers<3>("--light", parts[1], "X,Y,Z");
  const double intensity = parts.size() == 3 ? parseNumber<double>("--light", parts[2]) : 1;
  if (!(intensity >= 0 && intensity < 1e30))
    throw UsageError("--light: \"" + text + "\": the intensity is not >= 0");
  return {{"type", parts[0]}, {isPoint ? "position" : "direction", where}, {"intensity", intensity}};
}

InitWords wordsOf(const Options& options) {
  InitWords words = options.words;
  if (!options.unit.empty()) words.metersPerUnit = parseUnit(options.unit);
  if (!options.depth.empty()) words.deviceDepth = options.depth == "device";
  if (!options.eye.empty()) words.camera.eye = parseNumbers<3>("--eye", options.eye, "X,Y,Z");
  if (!options.target.empty()) words.camera.target = parseNumbers<3>("--target", options.target, "X,Y,Z");
  if (!options.up.empty()) words.camera.up = parseNumbers<3>("--up", options.up, "X,Y,Z");
  for (const auto& [role, name] : options.roles)
    if (!name.empty()) words.roles[role] = name;
  for (const std::string& light : options.lights) words.lights.push_back(lightOf(light));
  return words;
}

// What is there may hold a person's edits: the manifest itself asks for them.
void requireFree(const std::filesystem::path& output, const Options& options) {
  requireNoInput("-o", output, {options.files.begin(), options.files.end()});
  std::error_code error;
  if (!options.overwrite && std::filesystem::is_regular_file(output, error))
    throw UsageError("-o " + output.string() + ": is there; --overwrite replaces it, or -o names another file");
}

void init(const Options& options) {
  const std::filesystem::path output = options.output;
  requireFree(output, options);
  const std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  const GuessedManifest guessed = guessManifest(files, folder, wordsOf(options));
  writeWholeText(output, guessed.json.dump(1) + "\n");
  for (const std::string& line : guessed.found) std::printf("%s\n", line.c_str());
  if (!guessed.missing.empty()) {
    std::printf("missing most: %s\n", guessed.missing.front().c_str());
    for (std::size_t i = 1; i < guessed.missing.size(); ++i)
      std::printf("also missing: %s\n", guessed.missing[i].c_str());
  }
  std::printf(
      "wrote %s; its keys that begin with // say what is unknown\nnext: pellucid replay %s -o out.exr "
      "--png\n",
      output.c_str(), output.c_str());
}

}  // namespace

void addInitCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand("init", "Write a manifest for EXR files of another program");
  command.option("files", options->files, "EXR files of one frame: layers of one, or a file for each buffer")
      .required();
  command.option("-o,--output", options->output, "manifest to write");
  command.flag("--overwrite", options->overwrite, "replace a manifest that is there");
  InitWords& words = options->words;
  CameraWords& camera = words.camera;
  const Command cameras = command.group("Camera");
  cameras.option("--fov", camera.verticalFov, "vertical field of view, degrees").range(0.01, 179.0);
  cameras.option("--ortho-height", camera.orthographicHeight, "of an orthographic camera, scene units")
      .positive();
  cameras.option("--near", camera.nearPlane, "near plane, scene units").positive();
  cameras.option("--far", camera.farPlane, "far plane, scene units (default: infinitely far)").positive();
  cameras.flag("--reversed-z,!--forward-z", camera.reversedZ,
               "device depth 1 at the near plane (default: what the background says)");
  cameras.option("--eye", options->eye, "X,Y,Z: where the camera is");
  cameras.option("--target", options->target, "X,Y,Z: what it looks at");
  cameras.option("--up", options->up, "X,Y,Z: up in the world (default: 0,1,0)");
  const Command buffers =
      command.group("Buffers: a layer, a channel, a file without extension, or file:layer, in place of the guess");
  const std::pair<const char*, Role> roles[] = {{"--front-depth", Role::FrontDepth},
                                                {"--back-depth", Role::BackDepth},
                                                {"--irradiance", Role::Irradiance},
                                                {"--albedo", Role::Albedo},
                                                {"--material-index", Role::Material}};
  for (const auto& [name, role] : roles) buffers.option(name, options->roles[role]);
  const Command meanings = command.group("Meaning");
  meanings.option("--depth", options->depth, "viewz or device (default: device where all are within 0 .. 1)")
      .oneOf({"viewz", "device"});
  meanings.option("--irradiance-scale", words.irradianceScale, "factor of what is stored, as pi for E / pi")
      .positive();
  meanings.option("--unit", options->unit,
                  "mm, cm, m or a number of meters (default: what names say, else m)");
  meanings.option("--material-id", words.materialIds,
                  "stored value that is translucent, repeatable (default: all but 0)");
  meanings.option("--material", words.material,
                  "the translucent material: a preset, or a manifest's material in braces");
  meanings.option("--light", options->lights, std::string("repeatable: ") + kLightWords);
  command.run([options] { init(*options); });
}

}  // namespace pellucid::harness
