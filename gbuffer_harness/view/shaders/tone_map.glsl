// common/tone_map.cpp, which has the sources; a test compares the two.
const int kAgx = 1, kAces = 2;

const mat3 kInset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                         0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const mat3 kOutset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                          1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                          1.15107367264116);
const float kLeastStops = -12.47393, kMostStops = 4.026069;

float agxContrast(float x) {
  const float kPivot = 10.0 / 16.5;
  bool toe = x < kPivot;
  float power = toe ? 3.0 : 3.25;
  float across = toe ? kPivot : 1.0 - kPivot;
  float scale = pow(pow(2.0 * across, -power) * (pow(4.0 * across, power) - 1.0), -1.0 / power);
  float t = 2.0 * abs(x - kPivot) / scale;
  float y = scale * t / pow(1.0 + pow(t, power), 1.0 / power);
  return toe ? 0.5 - y : 0.5 + y;
}

vec3 agx(vec3 c) {
  vec3 stops = clamp(log2(max(kInset * c, 1e-10)), kLeastStops, kMostStops);
  vec3 x = (stops - kLeastStops) / (kMostStops - kLeastStops);
  vec3 encoded = kOutset * vec3(agxContrast(x.r), agxContrast(x.g), agxContrast(x.b));
  return pow(clamp(encoded, 0.0, 1.0), vec3(2.2));
}

vec3 toneMapped(int map, vec3 c) {
  if (map == kAgx) return agx(max(c, 0.0));
  if (map == kAces) {
    c = max(c, 0.0);
    return clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
  }
  return c;
}
