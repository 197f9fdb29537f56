#include <trocar/core/json.hpp>
#include <trocar/training/events/catalogue.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/facts/unit.hpp>

namespace trocar::training {
namespace {

constexpr ArgumentKind kNamed[] = {ArgumentKind::hand, ArgumentKind::mark, ArgumentKind::strand, ArgumentKind::body,
                                   ArgumentKind::vessel};

std::string type_of(const Parameter& p) {
  switch (p.kind) {
    case ArgumentKind::number:
      return std::string(unit_of(p.name).words);
    case ArgumentKind::range:
      return "two numbers, " + std::string(unit_of(p.name).words);
    case ArgumentKind::bodies:
      return "list of bodies";
    case ArgumentKind::body:
      return "body";
    case ArgumentKind::hand:
      return "hand";
    case ArgumentKind::strand:
      return "strand";
    case ArgumentKind::mark:
      return "mark";
    case ArgumentKind::marks:
      return "list of marks";
    case ArgumentKind::vessel:
      return "vessel";
    case ArgumentKind::word:
      return "word";
    case ArgumentKind::landmark:
      return "landmark of the strand";
  }
  return "";
}

Json parameters(const std::vector<Parameter>& list) {
  Json out = Json::array();
  for (const Parameter& p : list) {
    Json j{{"name", p.name}, {"type", type_of(p)}, {"meaning", p.meaning}};
    if (!p.needed) j["optional"] = true;
    if (p.kind == ArgumentKind::number) j["from"] = p.low, j["to"] = p.high;
    if (!p.words.empty()) j["words"] = p.words;
    out.push_back(std::move(j));
  }
  return out;
}

Json fact_json(const Fact& fact) {
  Json j{{"name", fact.name}, {"type", fact.is_truth ? "true or false" : unit_of(fact.name).words}};
  if (!fact.is_truth) j["from"] = fact.low, j["to"] = fact.high;
  j["meaning"] = fact.meaning;
  j["arguments"] = parameters(fact.parameters);
  return j;
}

Json event_json(const EventKind& event) {
  Json j{{"name", event.name}, {"meaning", event.meaning}, {"arguments", parameters(event.parameters)}};
  if (event.has_body) j["on"] = "a body";
  j["attributes"] = Json::array();
  for (const Attribute& a : event.attributes) {
    Json one{{"name", a.name}, {"type", a.is_truth ? "true or false" : unit_of(a.name).words}, {"meaning", a.meaning}};
    if (!a.is_truth) one["from"] = a.low, one["to"] = a.high;
    j["attributes"].push_back(std::move(one));
  }
  return j;
}

template <class Kind>
void note_lack(const Kind& kind, const sim::Model* model, Json& j) {
  if (model && !kind.lacks(*model).empty()) j["lacks"] = kind.lacks(*model);
}

}  // namespace

Json catalogue(const sim::Model* model) {
  Json out{{"facts", Json::array()}, {"events", Json::array()}};
  for (const Fact* fact : facts()) {
    out["facts"].push_back(fact_json(*fact));
    note_lack(*fact, model, out["facts"].back());
  }
  for (const EventKind* event : event_kinds()) {
    out["events"].push_back(event_json(*event));
    note_lack(*event, model, out["events"].back());
  }
  if (!model) return out;
  for (const ArgumentKind kind : kNamed) {
    std::vector<std::string> known;
    std::int32_t index = -1;
    find_named(*model, kind, "", index, known);
    Parameter p{"", kind, ""};
    out["names"][type_of(p)] = known;
  }
  return out;
}

}  // namespace trocar::training
