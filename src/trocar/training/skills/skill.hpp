// A hand skill: what a surgeon has learnt to do without thinking (approach a tube, close a clip slowly, suck a pool
// dry), run tick by tick on a Surgeon. A skill knows no exercise and no body of a scene: those are its parameters. It
// looks at the State as eyes and fingers would, ends when it is done, or gives up and says why.
//
// A new skill is one file, here or in a room for its field, that defines a Skill and its SkillKind, and one line in
// skills.inl.
//
//   class Withdraw final : public Skill { Progress work(Surgeon& op) override; ... };
//   extern const SkillKind kWithdraw{"withdraw", "draw an instrument back", {hand()}, 6, "...", nothing,
//   &making<Withdraw>};
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/training/facts/argument.hpp>
#include <trocar/training/surgeon/surgeon.hpp>

namespace trocar::training {

enum class Progress { working, done, failed };

struct SkillKind;

/// A skill's arguments by the names of its parameters.
class SkillArgs {
 public:
  SkillArgs(const SkillKind& kind, const Arguments& arguments) : m_kind(&kind), m_arguments(&arguments) {}

  /// An argument that was not given, or that this kind of skill does not have, has `given == false`.
  const Argument& operator()(std::string_view name) const;
  int hand() const { return (*this)("hand").index; }
  double number(std::string_view name, double otherwise) const;
  bool equals(std::string_view name, std::string_view word) const { return (*this)(name).word == word; }

 private:
  const SkillKind* m_kind;
  const Arguments* m_arguments;
};

class Skill {
 public:
  virtual ~Skill() = default;

  /// In the tick before the first one. @param tries  how often it was begun before for the same goal
  void begin(Surgeon& op, int tries) {
    go(0);
    start(op, tries);
  }
  /// @param passed  since the tick before [s]
  Progress tick(Surgeon& op, double passed = sim::kTick) {
    m_in_phase += passed;
    return work(op);
  }
  /// Why it gave up, for people; empty: it did not.
  const std::string& why() const { return m_why; }

 protected:
  virtual void start(Surgeon&, int) { m_why.clear(); }
  virtual Progress work(Surgeon& op) = 0;

  Progress fail(std::string why) {
    m_why = std::move(why);
    return Progress::failed;
  }
  void go(int phase) {
    m_phase = phase;
    m_in_phase = m_steady = 0;
  }

  int m_phase = 0;
  double m_in_phase = 0, m_steady = 0;  ///< [s]

 private:
  std::string m_why;
};

/// What a scene lacks for a skill, for people; empty: nothing.
using SkillLacks = std::string (*)(const sim::Model& model, const SkillArgs& args);

struct SkillKind {
  std::string_view name;
  std::string_view doing;  ///< "approach the tissue"
  std::vector<Parameter> parameters;
  double patience = 15;  ///< at_most_s unless a plan says otherwise [s]
  std::string_view meaning;
  SkillLacks lacks;
  std::unique_ptr<Skill> (*make)(const sim::Model& model, const SkillArgs& args);
};

inline std::string nothing(const sim::Model&, const SkillArgs&) { return {}; }

template <class S>
std::unique_ptr<Skill> making(const sim::Model& model, const SkillArgs& args) {
  return std::make_unique<S>(model, args);
}

}  // namespace trocar::training
