#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

constexpr const SkillKind* kSkills[] = {
#define TROCAR_SKILL(name) &name,
#include <trocar/training/skills/skills.inl>
#undef TROCAR_SKILL
};

}  // namespace

std::span<const SkillKind* const> skills() { return kSkills; }

const SkillKind* find_skill(std::string_view name) {
  for (const SkillKind* kind : kSkills)
    if (kind->name == name) return kind;
  return nullptr;
}

}  // namespace trocar::training
