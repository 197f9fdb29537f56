#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

constexpr const SkillKind* kSkills[] = {
    &kLookAround, &kLookAt,  &kView,      &kInspect,         &kInspectStumps, &kHold,    &kWaitForBlood,
    &kMakeRoom,   &kPutDown, &kTake,      &kBringIn,         &kWithdraw,      &kFollow,  &kApproach,
    &kEnter,      &kGrasp,   &kClose,     &kLetGo,           &kLift,          &kLower,   &kClipAt,
    &kClipVessel, &kCutAt,   &kCoagulate, &kCoagulateVessel, &kSweep,         &kSuckDry,
};

}  // namespace

std::span<const SkillKind* const> skills() { return kSkills; }

const SkillKind* find_skill(std::string_view name) {
  for (const SkillKind* kind : kSkills)
    if (kind->name == name) return kind;
  return nullptr;
}

}  // namespace trocar::training
