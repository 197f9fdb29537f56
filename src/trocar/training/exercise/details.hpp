// Contents of a result beside steps and errors: facts that the file asks for, of each element of their set, and what
// was clipped and cut.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <trocar/training/rules/condition.hpp>

namespace trocar::training {

struct Part;

class Details {
 public:
  /// One entry of an exercise's `details`, for every element of its set.
  void read(const Part& part, const RuleReading& reading);
  /// Events of these kinds are reported.
  void watch(const EventWatches& events) { m_events = &events; }

  void sample(const Snapshot& snapshot);
  /// @param side  of what it happened to  @param good  no error was made by it
  void happened(int event, const EventInstance& h, const Snapshot& snapshot, const std::string& side, bool good);
  void tell(nlohmann::ordered_json& result) const;

 private:
  enum class Keep { last, most, range };
  struct Told {
    std::string name, side;
    const Fact* fact = nullptr;
    int watch = -1;
    const FactWatches* facts = nullptr;
    Condition while_true;
    Keep keep = Keep::last;
    bool known = false;
    double value = 0, least = 0;  ///< in the fact's unit; of a range, most and least
  };
  struct Done {
    const EventKind* event;
    std::string side, on;
    double at = 0;  ///< [s]
    bool good = false;
    std::vector<Value> attributes;
  };
  void read_one(const scene::JsonValue& value, const std::string& side, const RuleReading& reading);

  std::vector<Told> m_told;
  std::vector<Done> m_done;
  const EventWatches* m_events = nullptr;
};

}  // namespace trocar::training
