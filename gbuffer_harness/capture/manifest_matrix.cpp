#include "capture/manifest_matrix.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pellucid::harness {

Matrix invertible(const Field& field) {
  const Matrix matrix = field.numbers<16>();
  // Units differ between rows and columns; scale them away before judging the determinant.
  glm::dmat4 scaled;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      scaled[column][row] = matrix[static_cast<std::size_t>(column * 4 + row)];
  const auto largest = [](const glm::dvec4& v) {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::max(std::abs(v.z), std::abs(v.w)));
  };
  for (int pass = 0; pass < 2; ++pass) {  // first rows, then columns
    scaled = glm::transpose(scaled);
    for (int i = 0; i < 4; ++i)
      if (largest(scaled[i]) > 0) scaled[i] /= largest(scaled[i]);
  }
  if (!(std::abs(glm::determinant(scaled)) > 1e-10)) field.fail("the matrix is singular: " + field.shown());
  return matrix;
}

Matrix rigid(const Field& field) {
  Matrix m = field.numbers<16>();
  constexpr double kTolerance = 1e-3;  // matrices that went through float32 and a few products
  if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1) > kTolerance)
    field.fail(
        "the last row must be 0 0 0 1; matrices are column-major, with the translation in numbers 13 to 15");
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      const double dot = m[a * 4] * m[b * 4] + m[a * 4 + 1] * m[b * 4 + 1] + m[a * 4 + 2] * m[b * 4 + 2];
      if (std::abs(dot - (a == b ? 1 : 0)) > kTolerance)
        field.fail("must be rigid (rotation and translation, no scale), so that view units are scene units");
    }
  m[3] = m[7] = m[11] = 0;
  m[15] = 1;
  return m;
}

}  // namespace pellucid::harness
