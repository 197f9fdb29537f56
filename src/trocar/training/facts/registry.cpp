#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr const Fact* kFacts[] = {
#define TROCAR_FACT(name) &name,
#include <trocar/training/facts/facts.inl>
#undef TROCAR_FACT
};

}  // namespace

std::span<const Fact* const> facts() { return kFacts; }

const Fact* find_fact(std::string_view name) {
  for (const Fact* fact : kFacts)
    if (fact->name == name) return fact;
  return nullptr;
}

}  // namespace trocar::training
