#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/random.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/facts/argument.hpp>
#include <trocar/training/rules/sets.hpp>

namespace trocar::training {
namespace {

using scene::JsonValue;
using Kind = JsonValue::Kind;

/// Patterns are asked for by one of these keys.
struct ElementSource {
  const char* key;
  ArgumentKind kind;
};
constexpr ElementSource kElementSources[] = {
    {"marks", ArgumentKind::mark}, {"bodies", ArgumentKind::body}, {"hands", ArgumentKind::hand}};

class SetReader {
 public:
  SetReader(Set& set, const sim::Model* model, std::vector<core::Fault>& faults)
      : m_set(set), m_model(model), m_faults(faults) {}

  void elements(const JsonValue& list) {
    if (list.kind != Kind::array) return fault(list, "expected a list of elements, got " + scene::shown(list));
    if (list.items.size() > std::size_t(kMaxElements)) return too_many(list);
    for (const JsonValue& item : list.items) element(item);
  }

  void object(const JsonValue& value, std::uint64_t seed) {
    const std::vector<std::string> known{"elements", "held", "marks", "bodies", "hands", "order"};
    for (const scene::JsonMember& m : value.members)
      if (std::find(known.begin(), known.end(), m.key) == known.end())
        scene::tell(m_faults, {{m_set.file, m.line, m.column}, scene::unknown_name("key of a set", m.key, known)});
    if (const scene::JsonMember* held = value.find("held"))
      for (const JsonValue& v : held->value.items) m_set.held.push_back(v.text);
    const scene::JsonMember* list = value.find("elements");
    if (list) elements(list->value);
    bool made = list != nullptr;
    for (const ElementSource& source : kElementSources)
      if (const scene::JsonMember* pattern = value.find(source.key)) {
        if (made) fault(pattern->value, "expected one of elements, marks, bodies, hands, got several");
        made = true;
        matching(pattern->value, source.kind);
      }
    if (!made) fault(value, "expected elements, marks, bodies or hands in a set, got none");
    if (const scene::JsonMember* order = value.find("order")) put_in_order(order->value, seed);
  }

 private:
  void fault(const JsonValue& at, std::string message) {
    scene::tell(m_faults, {{m_set.file, at.line, at.column}, std::move(message)});
  }

  void too_many(const JsonValue& at) { fault(at, tr("expected at most {} elements of a set, got more", kMaxElements)); }

  void add(Element e, const JsonValue& at) {
    if (e.name.size() > kLongestTitle || e.title.size() > kLongestTitle)
      return fault(at, tr("expected a name and a title of at most {} bytes, got more", kLongestTitle));
    const auto same = [&e](const Element& other) { return other.name == e.name; };
    if (std::any_of(m_set.elements.begin(), m_set.elements.end(), same))
      return fault(at, tr("expected each element once, got \"{}\" again", e.name));
    m_set.elements.push_back(std::move(e));
  }

  void element(const JsonValue& item) {
    Element e;
    e.self = item;
    if (item.kind == Kind::string) {
      e.name = e.title = item.text;
      return add(std::move(e), item);
    }
    if (item.kind == Kind::broken) return;
    const scene::JsonMember* name = item.kind == Kind::object ? item.find("name") : nullptr;
    if (!name || name->value.kind != Kind::string)
      return fault(item, "expected a name, or an object with a name, got " + scene::shown(item));
    const scene::JsonMember* title = item.find("title");
    e.name = name->value.text;
    e.title = title && title->value.kind == Kind::string ? title->value.text : e.name;
    e.self = name->value;
    e.members = item;
    if (absent(item)) return;
    add(std::move(e), name->value);
  }

  /// Only some patients have it, and this one has not.
  bool absent(const JsonValue& item) {
    const scene::JsonMember* body = item.find("if_body");
    if (!body) return false;
    if (body->value.kind != Kind::string)
      fault(body->value, "expected the name of a body, got " + scene::shown(body->value));
    std::vector<std::string> known;
    std::int32_t index = -1;
    return m_model && !find_named(*m_model, ArgumentKind::body, body->value.text, index, known);
  }

  void matching(const JsonValue& pattern, ArgumentKind kind) {
    if (pattern.kind != Kind::string) return fault(pattern, "expected a pattern, got " + scene::shown(pattern));
    m_set.pending = m_model == nullptr;
    if (!m_model) {  // one that stands for all: what is said of each can be checked
      Element any{pattern.text, pattern.text, pattern, {}};
      return add(std::move(any), pattern);
    }
    std::vector<std::string> known;
    std::int32_t index = -1;
    find_named(*m_model, kind, "", index, known);
    for (const std::string& name : known) {
      if (!matches(pattern.text, name)) continue;
      if (m_set.elements.size() >= std::size_t(kMaxElements)) return too_many(pattern);
      Element e{name, name, pattern, {}};
      e.self.text = name;
      add(std::move(e), pattern);
    }
    if (m_set.elements.empty())
      fault(pattern, scene::unknown_name(std::string(noun(kind)) + " that matches", pattern.text, known));
  }

  void put_in_order(const JsonValue& order, std::uint64_t seed) {
    std::vector<Element>& all = m_set.elements;
    if (order.text == "by_name")
      std::sort(all.begin(), all.end(), [](const Element& a, const Element& b) { return a.name < b.name; });
    else if (order.text == "by_seed")
      shuffle(seed);
    else
      fault(order, scene::unknown_name("order", order.text, {"by_name", "by_seed"}));
  }

  /// Seed 0 keeps the order of the file: the standard patient.
  void shuffle(std::uint64_t seed) {
    if (seed == 0) return;
    core::Random random(seed);
    for (std::size_t i = m_set.elements.size(); i > 1; --i)
      std::swap(m_set.elements[i - 1], m_set.elements[std::min(i - 1, std::size_t(random.uniform() * double(i)))]);
  }

  Set& m_set;
  const sim::Model* m_model;
  std::vector<core::Fault>& m_faults;
};

}  // namespace

const JsonValue* Element::member(std::string_view key) const {
  const scene::JsonMember* m = members.find(key);
  return m ? &m->value : nullptr;
}

const Set* find_set(const Sets& sets, std::string_view name) {
  for (const Set& s : sets)
    if (s.name == name) return &s;
  return nullptr;
}

bool matches(std::string_view pattern, std::string_view name) {
  std::size_t at = 0, in = 0, star = pattern.npos, from = 0;  // the last star, and where in the name its letters end
  while (in < name.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      from = in;
    } else if (at < pattern.size() && pattern[at] == name[in]) {
      ++at, ++in;
    } else if (star != pattern.npos) {  // the star stands for one letter more; those before it need no other try
      at = star + 1;
      in = ++from;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', at) == pattern.npos;
}

Set read_set(const std::string& name, const JsonValue& value, const std::string& file, const sim::Model* model,
             std::uint64_t seed, std::vector<core::Fault>& faults) {
  Set set;
  set.name = name;
  set.file = file;
  set.at = value;
  SetReader reader(set, model, faults);
  if (value.kind == Kind::object)
    reader.object(value, seed);
  else if (value.kind != Kind::broken)
    reader.elements(value);
  return set;
}

}  // namespace trocar::training
