// Every convention, checked, in a sentence a person understands. In this order: each check relies on those
// before it, and on what readFrame has put into the facts between them.
#pragma once

#include "gather_choice.h"

namespace pellucid {

struct FrameFacts;

void checkFields(const Inputs& inputs, Findings& out);
void checkMaterials(const Inputs& inputs, Findings& out);
void checkShadowMaps(const Inputs& inputs, Findings& out);
void checkLights(const Inputs& inputs, const GatherChoice& gather, Findings& out);
// Checks one light, whose maps there are.
void checkFaces(const Inputs& inputs, uint32_t light, Findings& out);
void checkGroups(const FrameFacts& facts, Findings& out);
// Warnings, once nothing is wrong.
void warnOfShadowMaps(const FrameFacts& facts, Findings& out);

// The views a recording needs.
void checkViews(const FrameFacts& facts, Findings& out);

}  // namespace pellucid
