#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr const Fact* kFacts[] = {
    &kClock,
    &kMarkInView,
    &kMarkVisibleShare,
    &kMarkSeenFor,
    &kMarkOffCentre,
    &kMarkDistance,
    &kMarkFacing,
    &kMarkUnderLiquid,
    &kScopeHorizon,
    &kHandPull,
    &kHandPinch,
    &kHandContact,
    &kHandHolds,
    &kHandHeldAt,
    &kHandHoldsBetween,
    &kHandHas,
    &kHandClipsLeft,
    &kHandTipToMark,
    &kHandTipToHand,
    &kHandTipsInView,
    &kHandDepth,
    &kHandPath,
    &kHandActive,
    &kStrandStraightness,
    &kStrandSevered,
    &kStrandFollowed,
    &kStrandOccluded,
    &kStrandStumpsClosed,
    &kStrandStumpsInView,
    &kClipsFirstSet,
    &kClipsSecondSet,
    &kClipsMisplaced,
    &kClipsApart,
    &kBloodLost,
    &kBloodFlow,
    &kBloodSince,
    &kPoolVolume,
    &kBleederCalibre,
    &kBleederClipped,
    &kBleederSealed,
    &kBleederUncovered,
    &kTissueTemperature,
    &kTissueDeadBeyond,
    &kBodyParted,
};

}  // namespace

std::span<const Fact* const> facts() { return kFacts; }

const Fact* find_fact(std::string_view name) {
  for (const Fact* fact : kFacts)
    if (fact->name == name) return fact;
  return nullptr;
}

}  // namespace trocar::training
