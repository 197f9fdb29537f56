#include <iterator>

#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr const Fact* kFacts[] = {
#define TROCAR_FACT(name, label, shown) &name,
#include <trocar/training/facts/facts.inl>
#undef TROCAR_FACT
};

constexpr FactWords kWords[] = {
#define TROCAR_FACT(name, label, shown) {label, FactWords::Shown::shown},
#include <trocar/training/facts/facts.inl>
#undef TROCAR_FACT
};

}  // namespace

std::span<const Fact* const> facts() { return kFacts; }

const FactWords& words_of(const Fact& fact) {
  static constexpr FactWords kNone;
  for (std::size_t i = 0; i < std::size(kFacts); ++i)
    if (kFacts[i] == &fact) return kWords[i];
  return kNone;
}

const Fact* find_fact(std::string_view name) {
  for (const Fact* fact : kFacts)
    if (fact->name == name) return fact;
  return nullptr;
}

}  // namespace trocar::training
