// All skills that demonstrations can be written with. A new one is a line in skills.inl, and its file.
#pragma once

#include <span>

#include <trocar/training/skills/skill.hpp>

namespace trocar::training {

#define TROCAR_SKILL(name) extern const SkillKind name;
#include <trocar/training/skills/skills.inl>
#undef TROCAR_SKILL

std::span<const SkillKind* const> skills();
/// Null: there is none of that name.
const SkillKind* find_skill(std::string_view name);

}  // namespace trocar::training
