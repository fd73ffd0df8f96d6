// Factors that stand for the cosine of the light on the hidden face, which the camera does not see. x is the cosine
// between the view ray and the direction to the light. See PellucidAngleModel.
#ifndef PELLUCID_ANGLE_GLSL
#define PELLUCID_ANGLE_GLSL

// Whelan 2009, 4.4. The clamp keeps rounding from leaving the domain of acos.
float angleInverseCosine(float x) {
  const float kTwoOverPi = 0.63661977;
  return clamp(1.0 - kTwoOverPi * acos(clamp(x, -1.0, 1.0)), 0.0, 1.0);
}

// A polynomial of the angle between eye and light: Whelan 2009, eqs. 4.4 and 4.5. The outer clamp matters: the
// quadratic is negative from 96 to 123 degrees.
float anglePolynomial(vec4 c, float x) {
  float angle = 3.14159265 - acos(clamp(x, -1.0, 1.0));
  return x > 0.0 ? clamp(c.x + angle * (c.y + angle * (c.z + angle * c.w)), 0.0, 1.0) : 0.0;
}

#endif
