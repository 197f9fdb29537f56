// All skills that demonstrations can be written with, one line each.
#pragma once

#include <span>

#include <trocar/training/skills/skill.hpp>

namespace trocar::training {

extern const SkillKind kLookAround, kLookAt, kView, kInspect, kInspectStumps;
extern const SkillKind kHold, kWaitForBlood, kMakeRoom;
extern const SkillKind kPutDown, kTake, kBringIn, kWithdraw;
extern const SkillKind kFollow, kApproach, kEnter, kGrasp, kClose, kLetGo, kLift, kLower;
extern const SkillKind kClipAt, kClipVessel, kCutAt, kCoagulate, kCoagulateVessel, kSweep, kSuckDry;

std::span<const SkillKind* const> skills();
/// Null: there is none of that name.
const SkillKind* find_skill(std::string_view name);

}  // namespace trocar::training
