#include <fmt/format.h>

#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value left(const Moment& moment, const Arguments& a) {
  const int set = moment.model.bonds_index(a[0].word);
  if (set < 0) return kUnknown;
  return interactions::holding_share(moment.model.bonds[size_t(set)], moment.state.bonds[size_t(set)]);
}

std::string_view needs_bonds(const sim::Model& model) { return model.bonds.empty() ? "bonds of a pouch" : ""; }

std::string unknown_bonds(const sim::Model& model, const Arguments& a) {
  if (model.bonds_index(a[0].word) >= 0) return {};
  std::string known;
  for (const interactions::BondSet& set : model.bonds) known += (known.empty() ? "" : ", ") + set.name;
  return fmt::format("expected bonds of the scene ({}), got \"{}\"", known, a[0].word);
}

}  // namespace

const Fact kBondsLeft{"bonds.left_share",
                      {{"of", ArgumentKind::word, "bonds of a pouch, by their name"}},
                      0,
                      1,
                      "The share of the bonds' area that still holds: 1 before anything has been dissected, 0 when all "
                      "of it is free.",
                      needs_bonds,
                      &stateless<left>,
                      false,
                      &unknown_bonds};

}  // namespace trocar::training
