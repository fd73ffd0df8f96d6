// The samples that stand for a pixel of a multisampled G-buffer.
#ifndef PELLUCID_MULTISAMPLE_GLSL
#define PELLUCID_MULTISAMPLE_GLSL

const int kMostSamples = 16;

struct SampleChoice {
  uint samples;     // bits of the samples of the material that most samples have; all of them where none has one
  int first;        // the first of these
  float coverage;   // part of the pixel's samples that have any material
};

// material: of each sample, 0: none; count: samples, 1..kMostSamples. Equally many: the earlier material.
SampleChoice chooseSamples(uint material[kMostSamples], int count) {
  SampleChoice choice = SampleChoice((1u << count) - 1u, 0, 0.0);
  int most = 0, covered = 0;
  for (int i = 0; i < count; ++i) {
    if (material[i] == 0u) continue;
    ++covered;
    uint same = 0u;
    for (int k = 0; k < count; ++k) same |= uint(material[k] == material[i]) << k;
    if (bitCount(same) <= most) continue;
    most = bitCount(same);
    choice = SampleChoice(same, i, 0.0);
  }
  choice.coverage = float(covered) / float(count);
  return choice;
}

#endif
