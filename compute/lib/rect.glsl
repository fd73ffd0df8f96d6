#ifndef PELLUCID_RECT_GLSL
#define PELLUCID_RECT_GLSL

// `rect`: [xy, zw).
bool contains(ivec4 rect, ivec2 at) {
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}

#endif
