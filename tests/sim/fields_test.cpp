// Lists of fields (core/fields.hpp): each struct that a Model, a State or a step's scratch is made of names all of its
// fields, what is named counts in the hash, and poison reaches it.
#include <cstring>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <trocar/core/field_difference.hpp>
#include <trocar/core/memory.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/shown_difference.hpp>

#include "everything.hpp"
#include "field_count.hpp"
#include "needle_driver.hpp"
#include "shipped.hpp"
#include "small_energy.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

// ---- Every list is complete -------------------------------------------------------------------------------------

template <class T>
struct BaseOf {
  using type = void;
};
template <>
struct BaseOf<tissue::HeatModel> {
  using type = tissue::HeatDescription;
};
template <>
struct BaseOf<fluids::DropletModel> {
  using type = fluids::DropletDescription;
};
template <>
struct BaseOf<fluids::SmokeModel> {
  using type = fluids::SmokeDescription;
};
template <>
struct BaseOf<fluids::PoolModel> {
  using type = fluids::PoolDescription;
};

template <>
struct BaseOf<Model> {
  using type = interactions::BodyModels;
};
template <>
struct BaseOf<State> {
  using type = interactions::BodyStates;
};
template <>
struct BaseOf<Work> {
  using type = interactions::BodyWork;
};

template <class F>
constexpr std::size_t items_of = std::is_array_v<F> ? std::extent_v<F> : 1;

template <class T>
constexpr std::size_t fields_of_struct() {
  using Base = typename BaseOf<T>::type;
  if constexpr (std::is_void_v<Base>)
    return field_count::of<T>();
  else
    return field_count::of<T>() - 1 + field_count::of<Base>();
}

/// How many fields a list names, and how many bytes they are.
struct Listing {
  std::size_t fields = 0, bytes = 0;
  std::set<std::string> names;

  template <class F, class N = core::FieldNote>
  void operator()(const char* name, const F& /*field*/, N /*note*/ = {}) {
    if constexpr (!std::is_same_v<N, core::PartOfField>) {
      fields += items_of<F>;
      bytes += sizeof(F);
      EXPECT_TRUE(names.insert(name).second) << name << " is listed twice";
    }
  }
};

template <class T>
Listing listing_of() {
  static const T value{};
  Listing listing;
  T::fields(value, listing);
  return listing;
}

/// A number, a point, a rotation or a body's number: what is no struct of fields.
template <class F>
constexpr bool is_value = core::detail::Number<F> || core::detail::Point<F> || core::detail::Coded<F> ||
                          std::is_pointer_v<F> || std::is_same_v<F, Mat3d>;

/// Goes through a struct's list, and the lists of all that its fields are made of.
/// @tparam scratch  plain numbers in structs of their own need no list: they are only ever spoilt, as bytes
template <bool scratch>
class Completeness {
 public:
  template <class T>
  void check(const char* name) {
    if (!m_seen.insert(&id<T>).second) return;
    const Listing listing = listing_of<T>();
    if constexpr (std::is_aggregate_v<T>) {
      EXPECT_EQ(listing.fields, fields_of_struct<T>()) << "in the list of the struct of the field " << name;
    } else {  // of a class, by its bytes
      EXPECT_LT(sizeof(T) - listing.bytes, alignof(T)) << "in the list of the class of the field " << name;
    }
    if constexpr (core::ListedBytes<T>) {
      EXPECT_EQ(listing.bytes, sizeof(T)) << "padding in the struct of the field " << name;
    }
    static const T value{};
    T::fields(value, *this);
  }
  std::size_t structs() const { return m_seen.size(); }

  template <class F, class N = core::FieldNote>
  void operator()(const char* name, const F& /*field*/, N /*note*/ = {}) {
    look<F>(name);
  }

 private:
  template <class T>
  static constexpr char id = 0;

  template <class F>
  void look(const char* name) {
    look_at(name, static_cast<F*>(nullptr));
  }
  template <class E>
  void look_at(const char* name, std::vector<E>* /*type*/) {
    look<E>(name);
  }
  template <class E, std::size_t N>
  void look_at(const char* name, std::array<E, N>* /*type*/) {
    look<E>(name);
  }
  template <class E, std::size_t N>
  void look_at(const char* name, E (* /*type*/)[N]) {
    look<E>(name);
  }
  void look_at(const char* /*name*/, std::string* /*type*/) {}
  template <class E>
  void look_at(const char* /*name*/, std::shared_ptr<const E>* /*type*/) {}  // is there, and shared, whatever it holds
  template <class F>
  void look_at(const char* name, F* /*type*/) {
    if constexpr (core::Listed<F>)
      check<F>(name);
    else
      static_assert(is_value<F> || (scratch && std::is_trivially_copyable_v<F>),
                    "this struct needs a list of its fields");
  }

  std::set<const void*> m_seen;
};

struct Forgetful {
  std::vector<double> x;
  std::int32_t count = 0;
  float weight[3] = {0, 0, 0};
  std::string name;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("weight", s.weight), v("name", s.name, core::kNotHashed);
  }
};

// ---- What is listed counts --------------------------------------------------------------------------------------

template <class T>
constexpr char kType = 0;

/// Changes each hashed field that a value has anything in, one at a time, and asks for the hash.
class Changes {
 public:
  using Fields = std::map<std::pair<const void*, int>, std::string>;  ///< struct and number of the field: its path

  /// @param changed  fields that need not be looked at again
  /// @param grows    arrays without anything in them get an item
  Changes(std::function<std::uint64_t()> hash, Fields& changed, bool grows = false)
      : m_hash(std::move(hash)), m_as_it_is(m_hash()), m_changed(changed), m_grows(grows) {}

  template <class T>
  void through(T& value, const std::string& path) {
    Visitor v{*this, &kType<T>, path};
    T::fields(value, v);
  }

  Fields listed;

 private:
  struct Visitor {
    Changes& all;
    const void* type;
    const std::string& path;
    int number = 0;

    template <class F>
    void operator()(const char* name, F& field, const core::FieldNote& note = {}) {
      const std::pair<const void*, int> key{type, number++};
      const std::string here = path + "." + name;
      all.listed[key] = here;
      if (note.hashed) all.change(key, field, note, here);
    }
    template <class F>
    void operator()(const char*, F&, core::NotHashed) {}
    template <class F>
    void operator()(const char* name, F& field, core::PartOfField) {
      (*this)(name, field);
    }
  };
  using Key = std::pair<const void*, int>;

  template <class F>
  void flip(const Key& key, F* items, std::size_t count, const std::string& path) {
    if (count == 0 || !m_changed.emplace(key, path).second) return;
    const std::vector<F> before(items, items + count);
    if constexpr (std::is_integral_v<F> && !std::is_same_v<F, bool>)
      for (std::size_t i = 0; i < count; ++i) items[i] = F(items[i] > 0 ? items[i] - 1 : items[i] + 1);
    else if constexpr (std::is_same_v<F, bool>)
      items[0] = !items[0];
    else
      for (std::size_t i = 0; i < count; ++i) reinterpret_cast<unsigned char*>(items + i)[0] ^= 1;
    EXPECT_NE(m_hash(), m_as_it_is) << path << " does not count in the hash";
    std::copy(before.begin(), before.end(), items);
  }
  template <class F>
  void change(const Key& key, F& field, const core::FieldNote&, const std::string& path) {
    if constexpr (core::Bytes<F>)
      flip(key, &field, 1, path);
    else
      through_part(key, field, path);
  }
  template <class E>
  void change(const Key& key, std::vector<E>& field, const core::FieldNote& note, const std::string& path) {
    const bool grown = m_grows && field.empty() && note.first < 0;
    if (grown) field.resize(1);
    items(key, field.data(), note.first < 0 ? field.size() : std::size_t(note.first), note, path);
    if (grown) field.clear();
  }
  template <class E, std::size_t N>
  void change(const Key& key, std::array<E, N>& field, const core::FieldNote& note, const std::string& path) {
    items(key, field.data(), N, note, path);
  }
  template <class E, std::size_t N>
  void change(const Key& key, E (&field)[N], const core::FieldNote& note, const std::string& path) {
    items(key, field, note.first < 0 ? N : std::size_t(note.first), note, path);
  }
  template <class E>
  void items(const Key& key, E* items, std::size_t count, const core::FieldNote& note, const std::string& path) {
    if constexpr (core::Bytes<E>)  // of what is used here and there: all of it
      flip(key, items, note.loose ? count : std::min(count, std::size_t(1)), path);
    else
      for (std::size_t i = 0; i < count; ++i) part(key, items[i], path);
  }
  template <class E>
  void part(const Key& key, E& item, const std::string& path) {
    through_part(key, item, path);
  }
  template <class E>
  void part(const Key& key, std::vector<E>& item, const std::string& path) {
    change(key, item, {}, path);
  }
  template <class F>
  void through_part(const Key& key, F& field, const std::string& path) {
    m_changed.emplace(key, path);
    through(field, path);
  }

  std::function<std::uint64_t()> m_hash;
  std::uint64_t m_as_it_is;
  Fields& m_changed;
  bool m_grows;
};

/// A scene with everything, some moments after it began: blood, water, heat, clips and cuts.
const Model& everything_model() { return everything::model(); }

struct Lively {
  State state;
  Work work;
};
Lively lively_everything() {
  const Model& m = everything_model();
  Lively l{everything::laden(m, 2000), make_work(m)};
  const everything::Hands hands(m);
  const auto heated = [&] { return l.state.heat.listed > 0 && l.state.heat.empties > 0; };
  while (l.state.tick < 1000 && !(l.state.tick > 300 && heated())) step(m, hands.at(l.state.tick), l.state, l.work);
  EXPECT_TRUE(heated());
  for (const BodyId body : {BodyId::organ(0), BodyId::membrane(0)})
    l.state.scarred[size_t(l.state.scarred_count++)] = {body, 0, 0.9f, 1.2f};
  step(m, hands.at(l.state.tick), l.state, l.work);
  l.state.impact_count = std::max(l.state.impact_count, 1);
  return l;
}
Lively lively_small(std::uint64_t ticks) {
  const Model& m = small::model();
  Lively l{initial_state(m), make_work(m)};
  small::Hands hands(m);
  while (l.state.tick < ticks && !hands.done()) step(m, hands.next(l.state), l.state, l.work);
  return l;
}

const Model& digestive_model() { return shipped("digestive"); }
const Model& gallbladder_model() { return shipped("gallbladder"); }
const Model& calot_model() { return shipped("calot"); }
const Model& operation_model() { return shipped("cholecystectomy_operation"); }

/// A bag that is open, a stone in it and another one on the liver, cloth on the liver, too.
const Model& spill_model() { return shipped("cholecystectomy_spill"); }
Lively lively_bag() {
  const Model& m = spill_model();
  Lively l{initial_state(m), make_work(m)};
  interactions::BagState& bag = interactions::part_of<interactions::Bag>(l.state).front();
  const interactions::BagModel& model = interactions::part_of<interactions::Bag>(m).list.front();
  auto& stones = interactions::part_of<interactions::Rigid>(l.state);
  const kinematics::TipFrame hand = kinematics::forward(m.hands[1].port, pose_of(m.start.tools[1]));
  bag.hoop = bag.unrolled = 1;
  bag.frame = {hand.tip, hand.axis(), hand.normal()};
  for (size_t n = 0; n < bag.x.size(); ++n)
    bag.x[n] = bag.middle(model) + model.drawn[n].x * bag.frame.axis + model.drawn[n].y * bag.frame.side() +
               model.drawn[n].z * bag.frame.up;
  const Vec3d liver = vec_cast<double>(m.skin(m.organ_index("liver")).rest.front());
  bag.x[20] = stones[1].x = liver;
  stones[0].x = bag.x.back() + 0.003 * bag.frame.up;
  for (int i = 0; i < 2; ++i) step(m, m.start, l.state, l.work);
  return l;
}

const Model& reach_model() { return shipped("box_reach"); }
const Model& pegs_model() { return shipped("peg_transfer"); }

const Model& suture_model() { return shipped("box_suture"); }
const Model& loop_model() { return shipped("box_loop"); }
const Model& injection_model() { return shipped("gynaecology_injection"); }
/// With a hole, a bite, a clip, and thread that lies on itself and on a shaft, and is crushed there.
State stitched() {
  State s = initial_state(suture_model());
  interactions::SutureState& suture = interactions::part_of<interactions::Suture>(s).front();
  suture.hole_count = suture.bite_count = 1;
  suture.crushed = 1;
  suture.thread.self_count = suture.thread.touch_count = suture.thread.clip_count = 1;
  return s;
}
/// With the way of a needle that was drawn out.
State injected() {
  State s = initial_state(injection_model());
  s.injection.track_count = 1;
  s.injection.fills.back() = 1;  // hashed only while tissue resists
  return s;
}

// ---- Poison -----------------------------------------------------------------------------------------------------

/// Is every number of scratch overwritten? Notes which arrays had anything in them.
class Spoilt {
 public:
  std::map<std::string, bool> arrays;  ///< by path without numbers: was there anything in it

  template <class T>
  void through(const T& value, const std::string& path) {
    Visitor v{*this, path};
    T::fields(value, v);
  }

 private:
  struct Visitor {
    Spoilt& all;
    const std::string& path;

    template <class F, class N = core::FieldNote>
    void operator()(const char* name, const F& field, N note = {}) {
      if constexpr (!std::is_same_v<N, core::PartOfField>)
        if (!note.made_once) all.look(field, path + "." + name);
    }
  };

  void look(const bool& flag, const std::string& path) { EXPECT_TRUE(flag) << path; }
  template <class E>
  void look(E* const& pointer, const std::string& path) {
    EXPECT_EQ(pointer, nullptr) << path;
  }
  template <class E>
  void look(const std::span<E>& view, const std::string& path) {
    EXPECT_TRUE(view.empty()) << path;
  }
  template <class E>
  void look(const std::vector<E>& items, const std::string& path) {
    arrays[path] = arrays[path] || !items.empty();
    look_all(items.data(), items.size(), path);
  }
  template <class E, std::size_t N>
  void look(const std::array<E, N>& items, const std::string& path) {
    look_all(items.data(), N, path);
  }
  template <class E, std::size_t N>
  void look(const E (&items)[N], const std::string& path) {
    look_all(items, N, path);
  }
  template <class F>
  void look(const F& field, const std::string& path) {
    if constexpr (core::Bytes<F>)
      look_all(&field, 1, path);
    else
      through(field, path);
  }
  template <class E>
  void look_all(const E* items, std::size_t count, const std::string& path) {
    if constexpr (core::Bytes<E> && !std::is_pointer_v<E>) {
      const auto* bytes = reinterpret_cast<const unsigned char*>(items);
      EXPECT_TRUE(std::all_of(bytes, bytes + count * sizeof(E), [](unsigned char b) { return b == 0xff; })) << path;
    } else {
      for (std::size_t i = 0; i < count; ++i) look(items[i], path);
    }
  }
};

Work used_work(const Model& m, int ticks) {
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < ticks; ++i) step(m, m.start, s, w);
  return w;
}

}  // namespace

TEST(Fields, EveryStructOfModelStateAndWorkNamesAllOfItsFields) {
  Completeness<false> kept;
  kept.check<State>("State");
  kept.check<Model>("Model");
  Completeness<true> scratch;
  scratch.check<Work>("Work");
  EXPECT_GT(kept.structs() + scratch.structs(), 120u);
  static_assert(core::Listed<tissue::Box>, "a list that is private is none");
}

TEST(Fields, AListThatLeavesOneOutIsFound) {
  EXPECT_EQ(field_count::of<Forgetful>(), 6u) << "an array of C counts as its elements";
  EXPECT_EQ(listing_of<Forgetful>().fields, 5u) << "count is missing";
}

TEST(Fields, EveryFieldOfAStateThatIsListedCountsInItsHash) {
  Changes::Fields changed, listed;
  State states[] = {lively_everything().state,
                    lively_small(2600).state,
                    initial_state(gallbladder_model()),
                    initial_state(pegs_model()),
                    initial_state(small::statics()),
                    initial_state(calot_model()),
                    lively_bag().state,
                    initial_state(reach_model()),
                    stitched(),
                    initial_state(loop_model()),
                    injected()};
  states[2].bonds.emplace_back(1);
  states[2].declaring = 1;                                                       // hashed only while the key is down
  for (interactions::TouchBook& t : states[7].touches) t.joints.angle[0] = 0.3;  // only where something is bent
  for (interactions::TouchBook& t : states[7].touches) t.shift.x = 0.001;        // only where a trocar has moved
  states[7].ports.resize(2);
  for (State& state : states) {
    Changes changes([&] { return hash_of(state); }, changed);
    changes.through(state, "State");
    listed.merge(changes.listed);
  }
  for (const auto& [key, path] : listed) EXPECT_TRUE(changed.count(key)) << path << " was empty in all scenes";
}

TEST(Fields, EveryFieldOfAModelThatIsListedCountsInItsSeal) {
  Changes::Fields changed, listed;
  for (const bool grows : {false, true})
    for (const Model* m : {&everything_model(), &small::model(), &digestive_model(), &gallbladder_model(),
                           &pegs_model(), &small::statics(), &calot_model(), &spill_model(), &operation_model(),
                           &reach_model(), &suture_model(), &loop_model(), &injection_model()}) {
      Model model = *m;
      model.vessels.bleeder.vessel = 0;  // what no scene has is hashed as well where it is there
      model.wet.pool_at_start.saline = 1;
      if (!model.hands.empty()) model.hands[0].give.stiffness = 1000;
      model.bonds.emplace_back().bonds.emplace_back();
      model.bonds.back().breaches = true;
      if (m == &small::model()) model.solids[0].skin.more = model.solids[0].skin.weights;
      for (interactions::RigidModel& stone : interactions::part_of<interactions::Rigid>(model).list) stone.inside = 0;
      const auto sealed = [&] {
        seal(model);
        return model.hash;
      };
      Changes changes(sealed, changed, grows);
      changes.through(model, "Model");
      listed.merge(changes.listed);
    }
  for (const auto& [key, path] : listed) EXPECT_TRUE(changed.count(key)) << path << " was empty in all scenes";
}

TEST(Fields, WhatTheStepDoesNotReadIsNotInTheSeal) {
  Model model = small::model();
  model.name = "another", model.file = "elsewhere";
  model.drawn_detail.emplace_back();
  for (StrandAnatomy& s : model.strands) s.look = "painted";
  seal(model);
  EXPECT_EQ(model.hash, small::model().hash);
}

TEST(Fields, PoisonReachesEveryArrayOfWork) {
  // One tick fills them; after poison() no byte of them may be left as it was, and each of them is there in a scene.
  Spoilt spoilt;
  for (const Model* m :
       {&everything_model(), &small::model(), &small::energy(), &digestive_model(), &gallbladder_model(), &pegs_model(),
        &small::statics(), &calot_model(), &suture_model(), &loop_model(), &injection_model()}) {
    Work w = used_work(*m, 2);
    poison(w);
    spoilt.through(w, "Work");
  }
  Lively lively = lively_everything();
  poison(lively.work);
  spoilt.through(lively.work, "Work");
  Lively bag = lively_bag();
  poison(bag.work);
  spoilt.through(bag.work, "Work");
  NeedleDriver needle(suture_model(), suture_model().hand_index("right"));
  needle.drive({0, 0.077, -0.070}, {0, 0.063, -0.070}, 1.2, 1.2);  // into the pad
  NeedleDriver fallen(suture_model(), suture_model().hand_index("right"));
  fallen.input.tools[suture_model().hand_index("right")].handle = 0;
  fallen.rest(0.8);
  for (NeedleDriver* d : {&needle, &fallen}) {
    poison(d->work);
    spoilt.through(d->work, "Work");
  }
  EXPECT_GT(spoilt.arrays.size(), 150u);
  // these have no cells, and so neither guard nor volume force
  for (const std::string without : {"Work.membranes.body.network.", "Work.fat.fat.network."})
    for (const char* of_cells : {"open_tets", "below", "volume.places", "volume.answers", "volume.forces",
                                 "volume.bounds", "volume.node_answer"})
      EXPECT_EQ(spoilt.arrays.erase(without + of_cells), 1u) << without << of_cells;
  EXPECT_EQ(spoilt.arrays.erase("Work.objects.rigid.holds"), 1u) << "as many as jaws hold points of a ring";
  for (const auto& [path, filled] : spoilt.arrays) EXPECT_TRUE(filled) << path << " was empty in all scenes";
}

TEST(Fields, TheFirstFieldInWhichTwoStatesDifferHasAName) {
  const State a = initial_state(small::model());
  State b = a;
  EXPECT_EQ(first_difference(a, b), "");
  b.solids[1].nodes[3].vy = 0.25f;
  b.strands[0].x[2].y += 1;
  EXPECT_EQ(first_difference(a, b), "solids[1].nodes[3].vy: 0 and 0.25") << "the first in the order of the hash";
  b = a;
  b.tools[1].hold[2].local[0] = 0.5f;
  EXPECT_EQ(first_difference(a, b), "tools[1].hold[2].local[0]: 0 and 0.5");
  b = a;
  b.tools[0].hold[0].at.body = BodyId::wall();
  EXPECT_EQ(first_difference(a, b), "tools[0].hold[0].at.body: -1 and -2");
  b = a;
  b.strands[1].alive.pop_back();
  EXPECT_EQ(first_difference(a, b), "strands[1].alive.size: " + std::to_string(a.strands[1].alive.size()) + " and " +
                                        std::to_string(a.strands[1].alive.size() - 1));
  b = a;
  b.touches[0].touch[5].body = BodyId::organ(7);
  EXPECT_EQ(first_difference(a, b), "") << "beyond the book's count nothing is State";
  b.tick = 5;
  EXPECT_EQ(first_difference(a, b), "tick: 0 and 5");
}

TEST(Fields, AKeyframeNamesWhatIsDrawnOtherwise) {
  const Model& m = small::model();
  const State recorded = initial_state(m);
  const std::vector<std::uint8_t> keyframe = display_bytes(m, recorded);
  State now = recorded;
  EXPECT_EQ(shown_difference(m, keyframe, now), "");
  now.solids[0].nodes[0].vx = 1;
  EXPECT_EQ(shown_difference(m, keyframe, now), "") << "velocities are not in keyframes";
  now.tools[0].depth = 0.5;
  EXPECT_EQ(shown_difference(m, keyframe, now),
            "tools[0].depth: " + core::exact_text(recorded.tools[0].depth) + " and 0.5");
  now = recorded;
  now.strands[0].x[1].z += 0.001;
  EXPECT_EQ(shown_difference(m, keyframe, now).substr(0, 15), "strands[0].x[1]");
}

TEST(Fields, TheMemoryOfAStateIsThatOfAllItsArrays) {
  const State s = initial_state(everything_model());
  const std::size_t drops = std::size_t(everything_model().wet.model.droplets.capacity);
  EXPECT_GT(core::memory_of(s), sizeof s + drops * (7 * sizeof(float) + sizeof(fluids::Ground)));
}
