// Manual pages in the language of man(7).
#include <fmt/format.h>

#include <trocar/core/letters.hpp>

#include "commands/environment.hpp"
#include "commands/help_texts.hpp"

namespace trocar::app {
namespace {

/// Text for roff: no line begins with a control character, hyphens and backslashes are literal.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\\\";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    begins = c == '\n';
  }
  return out;
}

std::string heading(const std::string& title) {
  return fmt::format(".TH {} 1 \"\" \"Trocar {}\" \"User Commands\"\n", roff(core::in_capitals(title)),
                     roff(TROCAR_VERSION));
}

std::vector<const CLI::Option*> options_of(const CLI::App& app, bool positional) {
  return app.get_options(
      [positional](const CLI::Option* o) { return o->get_positional() == positional && !o->get_group().empty(); });
}

/// "--seed UINT" or "exercise"
std::string named(const CLI::Option& o) {
  if (o.get_positional()) return o.get_name(true);
  const std::string value = o.get_items_expected_max() > 0 ? " " + o.get_type_name() : "";
  return o.get_name(false, true) + value;
}

std::string listed(const std::vector<const CLI::Option*>& options) {
  std::string text;
  for (const CLI::Option* o : options) {
    text += fmt::format(".TP\n.B {}\n{}", roff(named(*o)), roff(o->get_description()));
    if (!o->get_default_str().empty()) text += roff(fmt::format(" [default: {}]", o->get_default_str()));
    text += o->get_required() ? " (required)\n" : "\n";
  }
  return text;
}

/// The options under the headings of their groups.
std::string options_text(const CLI::App& app) {
  std::string text = listed(options_of(app, true));
  for (const std::string& group : app.get_groups()) {
    std::vector<const CLI::Option*> of_group;
    for (const CLI::Option* o : options_of(app, false))
      if (o->get_group() == group) of_group.push_back(o);
    if (of_group.empty()) continue;
    if (group != "Options") text += fmt::format(".SS {}\n", roff(group));
    text += listed(of_group);
  }
  return text;
}

std::string synopsis(const CLI::App& app, const std::string& name) {
  std::string text = fmt::format(".B {}\n", roff(name));
  for (const CLI::Option* o : options_of(app, true))
    text += o->get_required() ? fmt::format(".I {}\n", roff(o->get_name(true)))
                              : fmt::format(".RI [ {} ]\n", roff(o->get_name(true)));
  return text + "[\\fIoptions\\fR]\n";
}

/// The lines after "Example:" of a footer.
std::string examples(const CLI::App& app) {
  const std::string footer = app.get_footer();
  const std::size_t from = footer.find('\n');
  if (footer.rfind("Example:", 0) != 0 || from == std::string::npos) return {};
  return fmt::format(".SH EXAMPLES\n.nf\n{}\n.fi\n", roff(footer.substr(from + 1)));
}

HelpFile command_page(const CLI::App& program, const CLI::App& command) {
  const std::string name = fmt::format("{}-{}", program.get_name(), command.get_name());
  const std::string spoken = fmt::format("{} {}", program.get_name(), command.get_name());
  std::string text = heading(name);
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(command.get_description()));
  const std::vector<const CLI::App*> parts = commands_of(command);
  text += ".SH SYNOPSIS\n";
  if (parts.empty()) text += synopsis(command, spoken);
  for (const CLI::App* part : parts) text += synopsis(*part, spoken + " " + part->get_name()) + ".br\n";
  text += ".SH OPTIONS\n" + options_text(command);
  for (const CLI::App* part : parts)
    text += fmt::format(".SH {}\n{}\n{}", roff(core::in_capitals(part->get_name())), roff(part->get_description()),
                        options_text(*part));
  text += examples(command);
  for (const CLI::App* part : parts) text += examples(*part);
  text += ".SH SEE ALSO\n.BR trocar (1)\n";
  return {name + ".1", text};
}

HelpFile program_page(const CLI::App& program) {
  std::string text = heading(program.get_name());
  text += ".SH NAME\ntrocar \\- open real\\-time trainer for endoscopic surgery\n";
  text += ".SH SYNOPSIS\n.B trocar\n.RI [ command ]\n[\\fIoptions\\fR]\n";
  text +=
      ".SH DESCRIPTION\nWithout a command the start screen opens.\nEvery command has a page of its own.\n"
      "A command prints one JSON object on standard output with\n.BR \\-\\-json .\n.SH COMMANDS\n";
  for (const CLI::App* c : commands_of(program))
    text += fmt::format(".TP\n.BR trocar\\-{} (1)\n{}\n", roff(c->get_name()), roff(c->get_description()));
  text += ".SH OPTIONS\n" + options_text(program) + ".SH ENVIRONMENT\n";
  for (const EnvironmentVariable& v : environment_variables())
    text += fmt::format(".TP\n.B {}\n{}\n", roff(v.name), roff(v.meaning));
  text +=
      ".SH EXIT STATUS\n.TP\n.B 0\ndone\n.TP\n.B 1\nthe goal was not reached, or verification failed\n.TP\n.B 2\n"
      "bad input\n.TP\n.B 3\nthe environment lacks something; the message names it\n"
      ".SH EXAMPLES\n.nf\n  trocar train gynaecology/sterilisation\n.fi\n";
  return {"trocar.1", text};
}

}  // namespace

std::vector<HelpFile> manual_pages(const CLI::App& program) {
  std::vector<HelpFile> pages{program_page(program)};
  for (const CLI::App* c : commands_of(program)) pages.push_back(command_page(program, *c));
  return pages;
}

}  // namespace trocar::app
