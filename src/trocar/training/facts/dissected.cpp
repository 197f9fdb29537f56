// What a dissection has parted and bared: facts of bonds and of fat.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/fat.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

constexpr double kAcross = 0.012;  // [m] how far sights go to both sides of a window's plane

std::string_view needs_fat(const sim::Model& model) { return model.fat.empty() ? "fat" : ""; }

constexpr int kTurns = 5;  // looked at ten times a second: what is asked there costs more than a tick should

template <double (*figure)(const sim::Model&, const sim::State&, const Arguments&)>
class Figure final : public Observer {
 public:
  Figure(const sim::Model&, const Arguments& a) : m_arguments(a) {}
  void sample(const Snapshot& snapshot, double) override {
    if (m_turn++ % kTurns == 0) m_value = figure(snapshot.model, snapshot.state, m_arguments);
  }
  Value value(const Snapshot&) const override { return m_turn > 0 ? Value(m_value) : kUnknown; }

 private:
  Arguments m_arguments;
  int m_turn = 0;
  double m_value = 0;
};

double volume_left(const sim::Model& model, const sim::State& state, const Arguments& a) {
  return fat_left(model, state, a[0].body());
}

class Bared final : public Observer {
 public:
  Bared(const sim::Model& model, const Arguments& a) : m_stretch(model, a[0].index) {}
  void sample(const Snapshot& snapshot, double) override {
    if (m_turn++ % kTurns == 0) m_value = m_stretch.longest(snapshot.state);
  }
  Value value(const Snapshot&) const override { return m_turn > 0 ? Value(m_value) : kUnknown; }

 private:
  BaredStretch m_stretch;
  int m_turn = 0;
  double m_value = 0;
};

double window_open(const sim::Model& model, const sim::State& state, const Arguments& a) {
  std::array<Vec3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = place_of_mark(model, state, a[i].index);
  return open_share(model, state, corners, kAcross);
}

double bridges(const sim::Model& model, const sim::State& state, const Arguments& a) {
  const std::vector<BodyId> to = bridged_from(model, state, a[0].body());
  return double(std::count_if(to.begin(), to.end(), [&a](BodyId body) {
    return std::find(a[1].bodies.begin(), a[1].bodies.end(), body) == a[1].bodies.end();
  }));
}

std::string no_fat(const sim::Model&, const Arguments& a) {
  return a[0].body().is(BodyKind::fat) ? "" : "expected fat, got another body";
}

Value bonds_left(const Snapshot& snapshot, const Arguments& a) {
  const int set = snapshot.model.bonds_index(a[0].word);
  if (set < 0) return kUnknown;
  return interactions::holding_share(snapshot.model.bonds[size_t(set)], snapshot.state.bonds[size_t(set)]);
}

Value bonds_breached(const Snapshot& snapshot, const Arguments& a) {
  const int set = snapshot.model.bonds_index(a[0].word);
  if (set < 0) return kUnknown;
  return interactions::breached_area(snapshot.model.bonds[size_t(set)], snapshot.state.bonds[size_t(set)]);
}

std::string_view needs_bonds(const sim::Model& model) {
  const auto of_membrane = [](const interactions::BondSet& set) { return set.of_membrane(); };
  return std::any_of(model.bonds.begin(), model.bonds.end(), of_membrane) ? "" : "bonds of a pouch";
}

std::string unknown_bonds(const sim::Model& model, const Arguments& a) {
  if (model.bonds_index(a[0].word) >= 0) return {};
  std::string known;
  for (const interactions::BondSet& set : model.bonds)
    if (set.of_membrane()) known += (known.empty() ? "" : ", ") + set.name;
  return tr("expected bonds of the scene ({}), got \"{}\"", known, a[0].word);
}

}  // namespace

const Fact kBondsLeft{"bonds.left_share",
                      {{"of", ArgumentKind::word, "bonds of a pouch, by their name"}},
                      0,
                      1,
                      "The share of the bonds' area that is intact: 1 before any dissection, 0 when all "
                      "of it is free.",
                      needs_bonds,
                      &stateless<bonds_left>,
                      false,
                      &unknown_bonds};

const Fact kBondsBreached{"bonds.breached_mm2",
                          {{"of", ArgumentKind::word, "bonds of a pouch, by their name"}},
                          0,
                          1e6,
                          "Area torn out of the organ in place of bonds that are tougher than "
                          "the organ. 0 where no bond is.",
                          needs_bonds,
                          &stateless<bonds_breached>,
                          false,
                          &unknown_bonds};

const Fact kFatLeft{
    "fat.left_share",
    {{"of", ArgumentKind::body, "which fat"}},
    0,
    1,
    "The remaining share of its volume: not vaporised, and not torn off everything that it was attached to.",
    needs_fat,
    &remembering<Figure<volume_left>>,
    false,
    &no_fat};

const Fact kStrandBared{"strand.bared_mm",
                        {{"of", ArgumentKind::strand, "a duct or a vessel in fat"}},
                        0,
                        1000,
                        "The longest stretch that lay in fat and is now free of it in at least seven of "
                        "eight sectors around.",
                        needs_fat,
                        &remembering<Bared>};

const Fact kWindowOpen{
    "window.open_share",
    {{"a", ArgumentKind::mark, "a corner of the window"},
     {"b", ArgumentKind::mark, "another"},
     {"c", ArgumentKind::mark, "the third"}},
    0,
    1,
    "The share of 64 lines of sight through the triangle between three marks, from 12 mm in front of it to 12 mm "
    "behind it, that no fat blocks.",
    needs_fat,
    &remembering<Figure<window_open>>};

const Fact kFatBridges{"fat.bridges",
                       {{"from", ArgumentKind::body, "a body that fat is attached to"},
                        {"but", ArgumentKind::bodies, "bodies that are ignored", false}},
                       0,
                       1000,
                       "The number of other bodies that fat lobules still connect to this body.",
                       needs_fat,
                       &remembering<Figure<bridges>>};

}  // namespace trocar::training
