// `pellucid material`: the transmittance and the diffusion profile of a material.
#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "cli/commands.h"
#include "common/error.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

namespace {

constexpr std::array<const char*, 3> kChannelNames = {"R", "G", "B"};

const std::vector<double> kThickness = {0.1, 0.2, 0.5, 1, 2, 5, 10, 20};  // of the table, mm

struct Options {
  std::string name, spectral;
  std::optional<double> ior;
  bool list = false;
};

struct SpectrumFile {
  std::vector<double> wavelength, scattering, absorption;
};

// Three numbers a line, separated by commas: wavelength in nm, sigma_s and sigma_a in 1/mm. A first line
// that does not start with a number is a heading; empty lines and those that start with # are skipped.
SpectrumFile readSpectrum(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path, "", "the file cannot be read");
  SpectrumFile spectrum;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    line.erase(
        std::remove_if(line.begin(), line.end(), [](char c) { return c == ' ' || c == '\t' || c == '\r'; }),
        line.end());
    if (line.empty() || line[0] == '#') continue;
    std::array<double, 3> row = {};
    const char *at = line.data(), *const end = at + line.size();
    std::size_t read = 0;
    for (; read < row.size(); ++read) {
      const auto [stop, error] = std::from_chars(at, end, row[read]);
      if (error != std::errc() || (stop != end && *stop != ',')) break;
      at = stop == end ? end : stop + 1;
    }
    if (read == 0 && number == 1) continue;
    if (read < row.size() || at != end)
      throw InputError(path, "line " + std::to_string(number),
                       "\"" + line.substr(0, 60) + "\" is not three numbers");
    if (spectrum.wavelength.size() == PELLUCID_MAX_WAVELENGTHS)
      throw InputError(path, "line " + std::to_string(number),
                       "more than " + std::to_string(PELLUCID_MAX_WAVELENGTHS) + " wavelengths");
    spectrum.wavelength.push_back(row[0]);
    spectrum.scattering.push_back(row[1]);
    spectrum.absorption.push_back(row[2]);
  }
  return spectrum;
}

// Writes the options into a description, which points into `named` and `spectrum`.
PellucidMaterialDesc describe(const Options& options, MaterialSource& named, SpectrumFile& spectrum) {
  if (options.name.empty() == options.spectral.empty())
    throw UsageError(
        "give one of: a preset's name (see --list) or a manifest's material in braces, or --spectral");
  const bool braces = options.name.starts_with('{');
  if (braces && options.ior) throw UsageError("--ior: the braces say the index of refraction");

  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  if (!options.name.empty()) {
    named = parseMaterial("NAME", options.name);
    if (std::holds_alternative<GaussianMaterial>(named))
      throw UsageError("NAME: a sum of Gaussians is taken as it is, without the compiler");
    desc = describeMaterial(named, "NAME");
  }
  if (options.ior) {
    // 0 would stand for the default.
    if (*options.ior == 0) throw InputError("", "ior", "0 is less than 1");
    desc.ior = *options.ior;
  }
  if (!options.spectral.empty()) {
    spectrum = readSpectrum(options.spectral);
    desc.kind = PELLUCID_MATERIAL_SPECTRAL;
    desc.wavelengthCount = static_cast<std::uint32_t>(spectrum.wavelength.size());
    desc.wavelength = spectrum.wavelength.data();
    desc.spectralScattering = spectrum.scattering.data();
    desc.spectralAbsorption = spectrum.absorption.data();
  }
  return desc;
}

struct Compiled {
  PellucidMaterialDesc desc;
  PellucidMaterial material;
  PellucidMaterialReport report;
  std::string file;  // named in errors

  std::vector<PellucidSlab> slabs(const std::vector<double>& thickness) const {
    std::vector<PellucidSlab> result(3 * thickness.size());
    requireMaterial(file, [&](PellucidMessageFn note, void* user) {
      return pellucidMaterialSlabs(&desc, static_cast<std::uint32_t>(thickness.size()), thickness.data(),
                                   result.data(), note, user);
    });
    return result;
  }
};

// The parameters' names, in the order of PellucidMaterial::transmittance.
std::vector<const char*> parameterNames(const PellucidMaterial& material) {
  if (material.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2) return {"a1", "k1", "a2", "k2"};
  return {"a", "kappa", "z", "b", "c"};
}

// One row of three numbers.
void printRow(const std::string& title, const std::array<double, 3>& values) {
  std::cout << std::left << std::setw(26) << title << std::right << std::setprecision(6);
  for (const double value : values) std::cout << std::setw(14) << value;
  std::cout << '\n';
}

void print(const Compiled& compiled) {
  const PellucidMaterial& material = compiled.material;
  const auto row = [](const std::string& title, auto&& value) {
    printRow(title, {value(0u), value(1u), value(2u)});
  };
  const auto report = [&](std::uint32_t c) -> const PellucidChannelReport& {
    return compiled.report.channels[c];
  };

  std::cout << compiled.report.name << ", index of refraction " << compiled.report.ior
            << ". Lengths in mm.\n\n"
            << std::setw(26) << "";
  for (const char* channel : kChannelNames) std::cout << std::setw(14) << channel;
  std::cout << '\n';
  if (report(0).scattering + report(0).absorption > 0) {
    row("scattering (reduced)", [&](std::uint32_t c) { return report(c).scattering; });
    row("absorption", [&](std::uint32_t c) { return report(c).absorption; });
  }
  row("rho, half-space", [&](std::uint32_t c) { return report(c).rho; });

  std::cout << "\nT(d) = "
            << (material.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2
                    ? "a1 exp(-k1 d) + a2 exp(-k2 d)"
                    : "a / sinh(kappa d + z) + b exp(-c d)")
            << '\n';
  const std::vector<const char*> names = parameterNames(material);
  for (std::size_t i = 0; i < names.size(); ++i)
    row(names[i], [&](std::uint32_t c) { return static_cast<double>(material.transmittance[c][i]); });
  row("largest error, %", [&](std::uint32_t c) { return 100 * report(c).transmittanceError; });
  row("  from thickness", [&](std::uint32_t c) { return report(c).minThickness; });
  row("  to thickness", [&](std::uint32_t c) { return report(c).maxThickness; });

  std::cout << "\nDiffusion\n";
  row("Burley d", [&](std::uint32_t c) { return static_cast<double>(material.burleyDistance[c]); });
  row("radius of 99.9 %", [&](std::uint32_t c) { return static_cast<double>(material.radius[c]); });
  row("edge error of Gaussians", [&](std::uint32_t c) { return report(c).edgeError; });
  for (std::uint32_t i = 0; i < material.gaussianCount; ++i) {
    row("variance " + std::to_string(i),
        [&](std::uint32_t c) { return static_cast<double>(material.gaussianVariance[c][i]); });
    row("weight " + std::to_string(i),
        [&](std::uint32_t c) { return static_cast<double>(material.gaussianWeight[c][i]); });
  }

  std::cout << "\nTransmittance: exact under Lambertian light, exact at normal incidence, fitted\n";
  const std::vector<PellucidSlab> exact = compiled.slabs(kThickness);
  for (std::size_t i = 0; i < kThickness.size(); ++i) {
    std::ostringstream title;
    title << kThickness[i] << " mm";
    row(title.str(), [&](std::uint32_t c) { return exact[3 * i + c].transmittance; });
    row("  normal", [&](std::uint32_t c) { return exact[3 * i + c].transmittanceNormal; });
    row("  fitted",
        [&](std::uint32_t c) { return pellucidEvaluateTransmittance(&material, c, kThickness[i]); });
  }
}

void run(const Options& options) {
  if (options.list) {
    for (std::uint32_t i = 0; i < pellucidPresetCount(); ++i) std::cout << pellucidPresetName(i) << '\n';
    return;
  }
  MaterialSource named;
  SpectrumFile spectrum;
  Compiled compiled = {describe(options, named, spectrum), {}, {}, options.spectral};
  requireMaterial(compiled.file, [&](PellucidMessageFn note, void* user) {
    return pellucidCompileMaterial(&compiled.desc, &compiled.material, &compiled.report, note, user);
  });
  print(compiled);
}

}  // namespace

void addMaterialCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command =
      app.subcommand("material", "Compile a material: its T(d), profile and what the shaders evaluate");
  command.option("NAME", options->name,
                 "a preset, see --list, or a manifest's material in braces (docs/materials.md)");
  command.flag("--list", options->list, "print the presets' names");
  command.option("--ior", options->ior, "index of refraction, 1 to 3 (default: the preset's, else 1.4)");
  command.option("--spectral", options->spectral, "CSV of wavelength (nm), sigma_s, sigma_a (1/mm)");
  command.run([options] { run(*options); });
}

}  // namespace pellucid::harness
