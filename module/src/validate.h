// Every convention, checked, in a sentence a person understands. In this order: each check relies on those
// before it, and on what readFrame has put into the facts between them.
#pragma once

#include "findings.h"

namespace pellucid {

struct FrameFacts;

void checkFields(const FrameFacts& facts, Findings& out);
void checkMaterials(const FrameFacts& facts, Findings& out);
void checkShadowMaps(const FrameFacts& facts, Findings& out);
void checkLights(const FrameFacts& facts, Findings& out);
// Checks one light, whose maps there are.
void checkFaces(const FrameFacts& facts, uint32_t light, Findings& out);
void checkGroups(const FrameFacts& facts, Findings& out);
// Warnings, once nothing is wrong.
void warnOfShadowMaps(const FrameFacts& facts, Findings& out);

// The views a recording needs.
void checkViews(const FrameFacts& facts, Findings& out);

}  // namespace pellucid
