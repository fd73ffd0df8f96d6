// From the public description of a material to media, every field checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "pellucid/pellucid_material.h"
#include "source.h"

namespace pellucid::material {

// A wrong field; becomes a message and a result code at the C boundary.
struct Refusal : std::exception {
  Refusal(std::string f, std::string s, PellucidResult r = PELLUCID_ERROR_INVALID_ARGUMENT)
      : field(std::move(f)), sentence(std::move(s)), result(r) {}
  std::string field, sentence;
  PellucidResult result;
};

std::string number(double value);                       // shortest text that reads back the same
std::string indexed(std::string field, std::size_t i);  // "field[i]"

// Throw a Refusal unless low <= value <= high; NaN throws.
void requireRange(const std::string& field, double value, double low, double high);
void requireCount(const std::string& field, std::size_t value, std::size_t low, std::size_t high);

// In 1/mm and reduced by g, from the description's unit. Throws a Refusal naming the field given.
Coefficients checkedCoefficients(const PellucidMaterialDesc& desc, const std::string& scatteringField,
                                 const std::string& absorptionField, double scattering, double absorption);

// The kinds that are media; nothing for those that define T(d) and the profile directly. Throws a Refusal.
std::optional<Description> describe(const PellucidMaterialDesc& desc);

// The preset's name, or the kind; static string. The description has passed describe().
const char* kindName(const PellucidMaterialDesc& desc);

}  // namespace pellucid::material
