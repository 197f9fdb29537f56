// Pages are templates with holes that data fill: a page's words and structure stand in pages/*.html, what it says in
// JSON. The language is the part of Mustache that pages need:
//   {{name}}  {{a.b}}       a value, escaped for HTML; nothing where there is none
//   {{{name}}}              as it is: drawings, which are SVG already
//   {{#name}} .. {{/name}}  for an array once an element; else once, unless it is missing, null, false, "" or empty.
//                           Names within are looked up in the element first, then outside
//   {{^name}} .. {{/name}}  once, where the section above would not come
//   {{.}}                   the element itself
//   {{>file.html}}          another template, filled from where it stands
//   {{_ words }}            the words in the reader's language, escaped
//   {{! words }}            nothing
// Section marks, comments and templates that stand alone on a line leave no line behind.
//
//   const std::string page = fill(page_text("attempt.html"), data);
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <trocar/core/json.hpp>

namespace trocar::reports {

struct PageText {
  std::string_view name;  ///< of a file in pages/
  std::string_view text;
};
/// All of pages/, put into the library by the build.
std::span<const PageText> page_texts();

/// @throws std::logic_error where there is no such file
std::string_view page_text(std::string_view name);

/// @param data  an object; numbers stand as they are written in JSON, so who wants another form gives text
/// @throws std::logic_error where a section is not closed or a tag not known: a fault of the template
std::string fill(std::string_view page, const Json& data);

/// Text as HTML and SVG want it, also within quotes.
std::string escaped(const std::string& text);

/// A page as a file, at once. @throws core::EnvironmentLacks with the reason
void write_page(const std::filesystem::path& path, std::string_view text);

}  // namespace trocar::reports
