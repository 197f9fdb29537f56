// All facts that exercises can be written with, one line each.
#pragma once

#include <span>

#include <trocar/training/facts/fact.hpp>

namespace trocar::training {

extern const Fact kClock;
extern const Fact kMarkInView, kMarkVisibleShare, kMarkSeenFor, kMarkOffCentre, kMarkDistance, kMarkFacing,
    kMarkUnderLiquid;
extern const Fact kScopeHorizon;
extern const Fact kHandPull, kHandPinch, kHandContact, kHandHolds, kHandHeldAt, kHandHoldsBetween, kHandHas,
    kHandClipsLeft, kHandTipToMark, kHandTipToHand, kHandTipsInView, kHandDepth, kHandPath, kHandActive;
extern const Fact kStrandStraightness, kStrandSevered, kStrandFollowed, kStrandOccluded, kStrandStumpsClosed,
    kStrandStumpsInView;
extern const Fact kClipsFirstSet, kClipsSecondSet, kClipsMisplaced, kClipsApart;
extern const Fact kBloodLost, kBloodFlow, kBloodSince, kPoolVolume;
extern const Fact kBleederCalibre, kBleederClipped, kBleederSealed, kBleederUncovered;
extern const Fact kTissueTemperature, kTissueDeadBeyond, kBodyParted;

std::span<const Fact* const> facts();
/// Null: there is none of that name.
const Fact* find_fact(std::string_view name);

}  // namespace trocar::training
