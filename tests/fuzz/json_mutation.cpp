#include "json_mutation.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <trocar/core/random.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/training/exercise/exercise.hpp>

#include "archive.hpp"

namespace trocar::fuzz {
namespace {

using scene::JsonMember;
using scene::JsonValue;
using Kind = JsonValue::Kind;

/// Every row of every table, found once.
const std::vector<scene::Key>& known_keys() {
  static const std::vector<scene::Key> all = [] {
    std::vector<scene::Key> found;
    std::vector<std::string> seen;
    std::vector<const scene::Shape*> open{&scene::scene_shape(),       &scene::organ_shape(),
                                          &scene::instrument_shape(),  &scene::tissue_shape(),
                                          &scene::vessels_shape(),     &scene::mechanism_shape(),
                                          &training::exercise_shape(), &training::common_rules_shape()};
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (std::find(seen.begin(), seen.end(), open[i]->name) != seen.end()) continue;
      seen.push_back(open[i]->name);
      for (const scene::Key& key : open[i]->keys) {
        found.push_back(key);
        if (key.shape) open.push_back(&key.shape());
      }
    }
    return found;
  }();
  return all;
}

struct Place {
  std::string key;  // of the member; empty in arrays
  JsonValue* value;
};
void collect(JsonValue& v, const std::string& key, std::vector<Place>& places) {
  places.push_back({key, &v});
  for (JsonValue& item : v.items) collect(item, key, places);
  for (JsonMember& m : v.members) collect(m.value, m.key, places);
}

class Mutation {
 public:
  Mutation(JsonValue& root, unsigned seed) : m_random(seed) { collect(root, "", m_places); }

  void one() {
    Place& place = m_places[some(m_places.size())];
    JsonValue& v = *place.value;
    switch (some(8)) {
      case 0:
        v = copy_of(m_places[some(m_places.size())]);
        break;
      case 1:
        v = scene::json_number(interesting(place.key, v.number));
        break;
      case 2:
        v = simple();
        break;
      default:
        inside(place);
    }
  }

  std::size_t some(std::size_t n) { return std::size_t(m_random.next() % n); }
  const std::vector<Place>& places() const { return m_places; }

 private:
  JsonValue copy_of(const Place& place) { return JsonValue(*place.value); }

  JsonValue simple() {
    switch (some(6)) {
      case 0:
        return JsonValue{};
      case 1:
        return scene::json_flag(some(2) == 0);
      case 2:
        return scene::json_text("");
      case 3:
        return scene::json_array();
      case 4:
        return scene::json_object();
      default:
        return scene::json_text(known_keys()[some(known_keys().size())].name);
    }
  }

  /// Something that the key's range, or the machine's numbers, may trip over.
  double interesting(const std::string& name, double now) {
    static constexpr double kEdges[] = {0,     1,    -1,  0.5,  2,    3,           1e-3,        1e-9,   1e-300,
                                        1e300, 1e15, 1e9, -1e9, 1000, 4294967296., 2147483648., 5e-324, -0.0};
    if (some(4) == 0) return kEdges[some(std::size(kEdges))];
    if (some(3) == 0) return now * m_random.uniform(-2, 2);
    for (const scene::Key& key : known_keys()) {
      if (key.name != name || key.low >= key.high || some(3) == 0) continue;
      switch (some(4)) {
        case 0:
          return key.low;
        case 1:
          return key.high;
        case 2:
          return key.low - 1e-9 * (key.high - key.low);
        default: {
          const double u = m_random.uniform();
          return key.low + u * u * u * (key.high - key.low);
        }
      }
    }
    return now * m_random.uniform(0.5, 1.5);
  }

  void inside(Place& place) {
    JsonValue& v = *place.value;
    switch (v.kind) {
      case Kind::number:
        v.number = interesting(place.key, v.number);
        if (!std::isfinite(v.number)) v.number = 0;
        break;
      case Kind::boolean:
        v.truth = !v.truth;
        break;
      case Kind::string:
        text(v.text);
        break;
      case Kind::array:
        items(v.items);
        break;
      case Kind::object:
        members(v.members);
        break;
      default:
        v = simple();
    }
  }

  void text(std::string& s) {
    std::vector<const std::string*> others;
    for (const Place& p : m_places)
      if (p.value->kind == Kind::string) others.push_back(&p.value->text);
    if (some(3) > 0) {
      s = std::string(*others[some(others.size())]);
      return;
    }
    std::vector<std::uint8_t> bytes(s.begin(), s.end());
    const std::size_t before = bytes.size();
    bytes.resize(before + 16);
    const std::size_t now = before == 0 ? 0 : plain_mutation(bytes.data(), before, bytes.size());
    s.assign(bytes.begin(), bytes.begin() + std::ptrdiff_t(now));
    for (char& c : s)
      if (static_cast<unsigned char>(c) >= 0x80) c = '?';
  }

  void items(std::vector<JsonValue>& list) {
    if (list.empty()) return;
    const std::size_t i = some(list.size());
    switch (some(4)) {
      case 0:
        list.erase(list.begin() + std::ptrdiff_t(i));
        break;
      case 1:
        std::swap(list[i], list[some(list.size())]);
        break;
      default: {
        const JsonValue again = list[i];
        list.insert(list.begin() + std::ptrdiff_t(i), some(20) == 0 ? 40 : 1, again);
      }
    }
  }

  void members(std::vector<JsonMember>& list) {
    if (!list.empty() && some(2) == 0) {
      list.erase(list.begin() + std::ptrdiff_t(some(list.size())));
      return;
    }
    const Place& source = m_places[some(m_places.size())];
    const scene::Key& key = known_keys()[some(known_keys().size())];
    JsonMember m;
    m.key = some(2) == 0 && !source.key.empty() ? source.key : key.name;
    m.value = some(2) == 0 ? scene::json_number(interesting(key.name, 1)) : copy_of(source);
    list.push_back(std::move(m));
  }

  core::Random m_random;
  std::vector<Place> m_places;
};

/// The archive's files, one of which is read; false where it is no JSON.
struct Chosen {
  scene::MemoryFiles files;
  std::filesystem::path name;
  JsonValue root;
};
bool choose(std::string_view archive, std::uint64_t which, Chosen& chosen) {
  chosen.files = unpacked(archive);
  auto file = chosen.files.begin();
  std::advance(file, std::ptrdiff_t(which % chosen.files.size()));
  chosen.name = file->first;
  std::vector<core::Fault> faults;
  chosen.root = scene::parse_json(file->second, "", faults).root;
  return faults.empty();
}

std::size_t stored(Chosen& chosen, std::uint8_t* out, std::size_t capacity) {
  chosen.files[chosen.name] = scene::to_text(chosen.root);
  const std::string text = packed(chosen.files);
  if (text.size() > capacity) return 0;
  std::memcpy(out, text.data(), text.size());
  return text.size();
}

std::string_view view_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

std::vector<std::string> json_words() {
  std::vector<std::string> words{"true",    "false",   "null",  "//", "/*",          "*/",
                                 "\\u00e4", "\\ud800", "1e308", "-0", "=== b.json\n"};
  for (const scene::Key& key : known_keys()) {
    words.push_back('"' + key.name + "\":");
    for (const std::string& choice : key.choices) words.push_back('"' + choice + '"');
  }
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

std::size_t mutate_json(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed) {
  core::Random random(seed);
  Chosen chosen;
  if (random.next() % 8 == 0 || !choose(view_of(data, size), random.next(), chosen))
    return plain_mutation(data, size, capacity);
  const auto times = 1 + random.next() % 3;
  for (std::uint64_t n = 0; n < times; ++n) Mutation(chosen.root, unsigned(random.next())).one();
  const std::size_t now = stored(chosen, data, capacity);
  return now > 0 ? now : plain_mutation(data, size, capacity);
}

std::size_t cross_json(Bytes a, Bytes b, std::uint8_t* out, std::size_t capacity, unsigned seed) {
  core::Random random(seed);
  Chosen one, two;
  if (!choose(view_of(a.data(), a.size()), random.next(), one) ||
      !choose(view_of(b.data(), b.size()), random.next(), two)) {
    const std::size_t size = std::min(a.size(), capacity);  // as it was
    std::memcpy(out, a.data(), size);
    return size;
  }
  Mutation to(one.root, unsigned(random.next()));
  std::vector<Place> from;
  collect(two.root, "", from);
  const Place& place = to.places()[to.some(to.places().size())];
  std::vector<const Place*> like;
  for (const Place& p : from)
    if (p.key == place.key) like.push_back(&p);
  *place.value = JsonValue(*(like.empty() ? from[to.some(from.size())] : *like[to.some(like.size())]).value);
  return stored(one, out, capacity);
}

}  // namespace trocar::fuzz
