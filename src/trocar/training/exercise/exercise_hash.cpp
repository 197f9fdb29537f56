#include <trocar/core/hash.hpp>
#include <trocar/training/exercise/exercise_hash.hpp>

namespace trocar::training {
namespace {

using scene::JsonValue;

/// Sizes come first, so that what follows each other cannot be taken for something else.
class ExerciseHasher {
 public:
  void add(const std::string& text) {
    m_hasher.add(std::uint64_t(text.size()));
    m_hasher.add_bytes(text.data(), text.size());
  }
  void add(double number) { m_hasher.add(number); }
  void add(bool truth) { m_hasher.add(std::uint8_t(truth)); }
  void add(std::uint64_t count) { m_hasher.add(count); }
  void add(const std::vector<std::string>& texts) {
    add(std::uint64_t(texts.size()));
    for (const std::string& t : texts) add(t);
  }
  void add(const JsonValue& value) {
    m_hasher.add(std::uint8_t(value.kind));
    add(value.truth);
    add(value.number);
    add(value.text);
    add(std::uint64_t(value.items.size()));
    for (const JsonValue& item : value.items) add(item);
    add(std::uint64_t(value.members.size()));
    for (const scene::JsonMember& member : value.members) {
      add(member.key);
      add(member.value);
    }
  }
  void add(const Part& part) { add(part.value); }
  void add(const Limit& l) {
    add(l.name);
    add(l.low);
    add(l.high);
    add(l.is_range);
    for (const Limit::Elsewhere& e : l.elsewhere) {
      add(e.anatomy);
      add(e.low);
      add(e.high);
    }
  }
  void add(const StepText& s) {
    for (const std::string* text : {&s.name, &s.title, &s.hint, &s.for_each}) add(*text);
    add(s.weight);
    add(s.optional);
    add(s.part);
  }
  void add(const Penalty& p) {
    for (const std::string* text : {&p.code, &p.name, &p.meaning, &p.hint, &p.for_each}) add(*text);
    add(p.points);
    add(p.fail);
    for (const auto* list : {&p.implies, &p.may, &p.leaves, &p.misses}) add(*list);
    add(p.part);
    add(p.at);
  }
  void add(const RecordedChoices& r) {
    add(r.seed);
    for (const Choice& c : r.choices) {
      m_hasher.add(c.at);
      m_hasher.add(c.perturbation);
    }
  }
  template <class T>
  void all(const std::vector<T>& list) {
    add(std::uint64_t(list.size()));
    for (const T& item : list) add(item);
  }
  std::uint64_t value() const { return m_hasher.value(); }

 private:
  core::Hasher m_hasher;
};

}  // namespace

namespace {

void add_judged(const Exercise& e, ExerciseHasher& h) {
  for (const std::string* text : {&e.name, &e.title}) h.add(*text);
  for (const double number :
       {e.hold_time, e.expert_time, e.longest_time, e.quality_share, e.time_share, e.motion_share, e.pass_mark})
    h.add(number);
  h.all(e.limits);
  h.add(std::uint64_t(e.sets.size()));
  for (const auto& [name, part] : e.sets) {
    h.add(name);
    h.add(part);
  }
  h.all(e.steps);
  h.all(e.penalties);
  h.all(e.details);
}

}  // namespace

std::uint64_t judgement_hash(const Exercise& e) {
  ExerciseHasher h;
  add_judged(e, h);
  return h.value();
}

std::uint64_t hash_of(const Exercise& e) {
  ExerciseHasher h;
  add_judged(e, h);
  h.add(e.demonstration);
  h.all(e.recorded_choices);
  return h.value();
}

}  // namespace trocar::training
