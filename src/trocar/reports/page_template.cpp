#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/page_template.hpp>

namespace trocar::reports {
namespace {

using Text = std::string_view;

/// A mark between braces, and what stands before it.
struct Tag {
  char kind =
      0;  ///< '#', '^', '/', '>', '!', '_' (translated), '{' (as it is), 'v' (a value), 0: there is none, only text
  Text before, name;
};

Text trimmed(Text text) {
  const auto from = text.find_first_not_of(" \t\n");
  return from == Text::npos ? Text() : text.substr(from, text.find_last_not_of(" \t\n") - from + 1);
}

/// Does nothing but the mark stand on its line? Then the line goes with it: trims `before` and `rest`.
void take_line(Text& before, Text& rest, bool begins) {
  const auto line = before.find_last_of('\n');
  const Text indent = line == Text::npos ? before : before.substr(line + 1);
  const bool alone_before = (line != Text::npos || begins) && indent.find_first_not_of(" \t") == Text::npos;
  const auto end = rest.find_first_not_of(" \t");
  if (!alone_before || (end != Text::npos && rest[end] != '\n')) return;
  before.remove_suffix(indent.size());
  rest.remove_prefix(end == Text::npos ? rest.size() : end + 1);
}

/// Reads up to the next mark; `rest` goes on behind it.
Tag next_tag(Text& rest, bool begins) {
  const auto open = rest.find("{{");
  if (open == Text::npos) {
    const Text all = rest;
    rest = {};
    return {0, all, {}};
  }
  Tag tag{'v', rest.substr(0, open), {}};
  rest.remove_prefix(open + 2);
  const bool raw = !rest.empty() && rest[0] == '{';
  const Text closing = raw ? "}}}" : "}}";
  const auto close = rest.find(closing);
  if (close == Text::npos) throw std::logic_error("a page's template: a mark is not closed");
  tag.name = rest.substr(raw ? 1 : 0, close - (raw ? 1 : 0));
  rest.remove_prefix(close + closing.size());
  if (raw) {
    tag.kind = '{';
  } else if (!tag.name.empty() && Text("#^/>!_").find(tag.name[0]) != Text::npos) {
    tag.kind = tag.name[0];
    tag.name.remove_prefix(1);
    if (tag.kind != '_') take_line(tag.before, rest, begins);
  }
  tag.name = trimmed(tag.name);
  return tag;
}

/// What stands up to the end of section `name`, sections of the same name within it left in; `rest` goes on behind.
Text section(Text& rest, Text name) {
  const Text all = rest;
  for (int depth = 1;;) {
    const Text here = rest;
    const Tag tag = next_tag(rest, here.data() == all.data());
    if (tag.kind == 0) throw std::logic_error(tr("a page's template: section '{}' is not closed", name));
    if (tag.name != name) continue;
    depth += tag.kind == '#' || tag.kind == '^' ? 1 : tag.kind == '/' ? -1 : 0;
    if (depth == 0) return all.substr(0, std::size_t(tag.before.data() + tag.before.size() - all.data()));
  }
}

using Scopes = std::vector<const Json*>;  // innermost last

const Json* member(const Json& object, Text path) {
  const Json* at = &object;
  while (!path.empty()) {
    const auto dot = path.find('.');
    const auto found = at->is_object() ? at->find(std::string(path.substr(0, dot))) : at->end();
    if (!at->is_object() || found == at->end()) return nullptr;
    at = &*found;
    path = dot == Text::npos ? Text() : path.substr(dot + 1);
  }
  return at;
}

const Json* look_up(const Scopes& scopes, Text name) {
  if (name == ".") return scopes.back();
  for (auto scope = scopes.rbegin(); scope != scopes.rend(); ++scope)
    if (const Json* found = member(**scope, name)) return found;
  return nullptr;
}

bool says_no(const Json* value) {
  if (!value || value->is_null()) return true;
  if (value->is_boolean()) return !value->get<bool>();
  if (value->is_string()) return value->get_ref<const std::string&>().empty();
  return value->is_structured() && value->empty();
}

std::string as_text(const Json* value) {
  if (!value || value->is_null()) return "";
  return value->is_string() ? value->get<std::string>() : value->dump(-1, ' ', false, Json::error_handler_t::replace);
}

void fill_into(std::string& out, Text page, Scopes& scopes);

void fill_section(std::string& out, Text inside, const Json& value, Scopes& scopes) {
  const auto with = [&](const Json& scope) {
    scopes.push_back(&scope);
    fill_into(out, inside, scopes);
    scopes.pop_back();
  };
  if (!value.is_array()) return with(value);
  for (const Json& element : value) with(element);
}

void fill_into(std::string& out, Text page, Scopes& scopes) {
  for (Text rest = page; !rest.empty();) {
    const Tag tag = next_tag(rest, rest.data() == page.data());
    out += tag.before;
    const Json* value = Text("!>_").find(tag.kind) != Text::npos || tag.kind == 0 ? nullptr : look_up(scopes, tag.name);
    switch (tag.kind) {
      case 'v':
        out += escaped(as_text(value));
        break;
      case '_':
        out += escaped(tr(std::string(tag.name).c_str()));
        break;
      case '{':
        out += as_text(value);
        break;
      case '#': {
        const Text inside = section(rest, tag.name);
        if (!says_no(value)) fill_section(out, inside, *value, scopes);
        break;
      }
      case '^': {
        const Text inside = section(rest, tag.name);
        if (says_no(value)) fill_into(out, inside, scopes);
        break;
      }
      case '>':
        fill_into(out, page_text(tag.name), scopes);
        break;
      case '/':
        throw std::logic_error(tr("a page's template: section '{}' ends before it begins", tag.name));
      default:  // only text, or words for people
        break;
    }
  }
}

}  // namespace

std::string_view page_text(std::string_view name) {
  for (const PageText& page : page_texts())
    if (page.name == name) return page.text;
  throw std::logic_error(tr("there is no page '{}'", name));
}

std::string fill(std::string_view page, const Json& data) {
  std::string out;
  Scopes scopes{&data};
  fill_into(out, page, scopes);
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        // Control characters are not allowed in a page whatever they are written as.
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

void write_page(const std::filesystem::path& path, std::string_view text) {
  if (const std::string said = core::write_file(path, {text}); !said.empty())
    throw core::EnvironmentLacks(tr("cannot write {}: {}", path.string(), said));
}

}  // namespace trocar::reports
