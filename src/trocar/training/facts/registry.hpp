// All facts that exercises can be written with. A new one is a line in facts.inl, and its file.
#pragma once

#include <span>

#include <trocar/training/facts/fact.hpp>

namespace trocar::training {

#define TROCAR_FACT(name, label, shown) extern const Fact name;
#include <trocar/training/facts/facts.inl>
#undef TROCAR_FACT

std::span<const Fact* const> facts();
/// How a fact is called where a trainee reads its value.
struct FactWords {
  enum class Shown { plain, percent };
  const char* label = "";  ///< "Distance"; to be shown by tr()
  Shown shown = Shown::plain;
};
const FactWords& words_of(const Fact& fact);
/// Null: there is none of that name.
const Fact* find_fact(std::string_view name);

}  // namespace trocar::training
