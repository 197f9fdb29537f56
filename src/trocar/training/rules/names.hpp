// What "$..." means at a place of an exercise file: a limit, a set, within `for_each` an element of the set or one of
// its members. Anyone who reads a part of the file (conditions, steps, demonstrations) is given a RuleReading: what is
// named there, the scene, and where faults go.
//
//   "$first_clip_mm"   a limit
//   "$side"            within for_each "side": the element's name; elsewhere: the names of all
//   "$side.tube"       within for_each "side": its member; elsewhere: that member of all
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <trocar/sim/model/model.hpp>
#include <trocar/training/rules/limits.hpp>
#include <trocar/training/rules/sets.hpp>
#include <trocar/training/rules/step_status.hpp>

namespace trocar::training {

using Faults = std::vector<core::Fault>;

class Names {
 public:
  Names() = default;
  Names(Limits limits, Sets sets);

  /// The same place within `for_each` of a set, at one of its elements. Both must be of these names.
  Names at(const Set& set, const Element& element) const;

  const Limits& limits() const { return m_tables->limits; }
  const Sets& sets() const { return m_tables->sets; }
  const Limit* limit(std::string_view name) const { return find_limit(limits(), name); }
  const Set* set(std::string_view name) const { return find_set(sets(), name); }
  /// The element that `for_each` of this set has come to; null outside of it.
  const Element* bound(std::string_view set) const;

  /// Puts limits and elements into a text for people: {clip_angle_deg}, {name}, {title}, {n}, {of} (the set's size) of
  /// the innermost element.
  std::string text(const std::string& pattern) const;
  /// The title of what a name of the scene is called in the file's sets, else the name.
  std::string title_of(const std::string& name) const;

 private:
  struct Tables {
    Limits limits;
    Sets sets;
  };
  struct Bound {
    const Set* set;
    const Element* element;
  };
  std::shared_ptr<const Tables> m_tables = std::make_shared<Tables>();
  std::vector<Bound> m_bound;
};

class FactWatches;
class EventWatches;

/// A name, and where it stands.
struct NameAt {
  std::string name;
  core::Location at;
};

/// A number or a range, in SI.
struct Interval {
  double low = 0, high = 0;
  bool is_range = false;
};

/// What a file may come to with one of each part for each element of its sets: conditions, acts, names, skills with
/// their parameters. Counted while it is read, as a few lines that repeat each other would take all memory.
inline constexpr std::size_t kMostParts = 100'000;

/// With what a part of a file is read.
struct RuleReading {
  const Names* named = nullptr;
  const sim::Model* model = nullptr;  ///< null: all is checked but what only a scene can tell
  FactWatches* facts = nullptr;       ///< of the attempt; null with the model
  EventWatches* events = nullptr;     ///< likewise
  const Steps* steps = nullptr;       ///< of the attempt, for which conditions may ask
  const std::string* file = nullptr;  ///< of the part that is read
  Faults* faults = nullptr;
  int depth = 0;                                                          ///< of references within references
  std::shared_ptr<std::size_t> parts = std::make_shared<std::size_t>(0);  ///< of the whole file, so far

  RuleReading within(const Names& other) const {
    RuleReading r = *this;
    r.named = &other;
    return r;
  }
  void fault(const scene::JsonValue& at, std::string message) const;
  /// Counts parts that are about to be read. False: with them the file is full, which a fault has told.
  bool has_room(const scene::JsonValue& at, std::size_t count = 1) const;
  /// Nothing more is read: there are too many parts, or enough faults.
  bool is_full() const;
  core::Location at(const scene::JsonValue& value) const { return {*file, value.line, value.column}; }
  /// Every key of the object is one of these, or a fault.
  void check_keys(const scene::JsonValue& object, const std::string& what, const std::vector<std::string>& known) const;

  /// What the value says: a number or [from, to], written there in `unit`, or a limit of that unit, or a number of an
  /// element. Nothing: a fault has been reported.
  std::optional<Interval> interval(const scene::JsonValue& value, const Unit& unit) const;
  std::optional<double> number(const scene::JsonValue& value, const Unit& unit) const;
  /// The same within [low, high], in the unit.
  std::optional<double> number(const scene::JsonValue& value, const Unit& unit, double low, double high) const;
  /// A text for people with its fields filled in (Names::text); empty where the value is no string, or the file is
  /// full.
  std::string text(const scene::JsonValue& value) const;
  /// Names: one, a list, "$element", "$element.member", "$set".
  std::vector<NameAt> names(const scene::JsonValue& value) const;
  /// Exactly one. Nothing: a fault has been reported, or the set that it is of waits for its scene.
  std::optional<NameAt> name(const scene::JsonValue& value) const;
};

}  // namespace trocar::training
