// What a fact or an event is asked with: which body, hand or mark of the scene, and which numbers. Each parameter has a
// type, and a unit if it is a number (facts/unit.hpp); the rules' reader checks both.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/sim/model/model.hpp>

namespace trocar::training {

enum class ArgumentKind {
  number,    ///< in the unit that the parameter's name ends in
  range,     ///< two of them
  hand,      ///< a trocar's name -> number of the hand
  strand,    ///< -> number of the strand
  body,      ///< organ, strand or fold -> its code (BodyId); kNoBody: a fold that is drawn only
  bodies,    ///< several
  mark,      ///< something whose visibility the scene knows -> number of the target
  marks,     ///< several
  vessel,    ///< -> its number
  word,      ///< one of Parameter::words, or any
  landmark,  ///< a word: of the strand that the parameter before it names
};

struct Parameter {
  std::string_view name;
  ArgumentKind kind;
  std::string_view meaning;
  bool needed = true;
  double low = 0, high = 1e4;  ///< of numbers, in the parameter's unit
  std::vector<std::string> words = {};
};

inline constexpr BodyId kNoBody;

/// One parameter's value. What was not given is `given == false`.
struct Argument {
  bool given = false;
  std::int32_t index = -1;
  double low = 0, high = 0;  ///< SI; of a number both are it
  std::string word;
  std::vector<BodyId> bodies;
  std::vector<std::int32_t> marks = {};

  bool operator==(const Argument&) const = default;
  BodyId body() const { return BodyId::of_code(index); }
  double number() const { return low; }
  bool holds(double v) const { return v >= low && v <= high; }
};

/// In the order of the parameters.
using Arguments = std::vector<Argument>;

/// A name of the scene as the index that `kind` asks for. @return false: the scene has nothing of that name, and
/// `known` then lists what there is.
bool find_named(const sim::Model& model, ArgumentKind kind, const std::string& name, std::int32_t& index,
                std::vector<std::string>& known);
/// "a hand", "a strand" ... for faults.
std::string_view noun(ArgumentKind kind);
bool names_something(ArgumentKind kind);

}  // namespace trocar::training
