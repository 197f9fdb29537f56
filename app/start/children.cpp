#include "start/children.hpp"

#include <sstream>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

constexpr double kNewsTime = 8;  // [s] that "is starting" stays
constexpr std::size_t kMostLines = 10;

/// "[12:00:01.5] [warning] text" -> "text"
std::string without_head(std::string line) {
  while (!line.empty() && line[0] == '[') {
    const std::size_t end = line.find("] ");
    if (end == std::string::npos) break;
    line.erase(0, end + 2);
  }
  return line;
}

/// Exit status 1 is a goal that was not reached, which is nobody's fault.
bool refused_with(int status, const std::string& errors) {
  return status > 1 || (status == 1 && errors.find("trocar failed") != std::string::npos);
}

}  // namespace

std::string last_lines(const std::string& text, std::size_t most) {
  std::vector<std::string> lines;
  std::istringstream each(text);
  for (std::string line; std::getline(each, line);)
    if (!line.empty()) lines.push_back(without_head(line));
  std::string out;
  for (std::size_t i = lines.size() > most ? lines.size() - most : 0; i < lines.size(); ++i)
    out += (out.empty() ? "" : "\n") + lines[i];
  return out;
}

Children::~Children() {
  for (const std::string& title : m_end_with_this) stop(title);
}

void Children::start(const ChildRequest& request) {
  if (running(request.title)) {
    m_news = tr("{}: already open in another window.", request.title);
  } else {
    try {
      std::vector<std::string> variables = request.variables;
      variables.emplace_back("TROCAR_WINDOW_LOG=");  // this window's own log
      m_running.emplace(request.title, ChildProgram(request.arguments, "", variables));
      if (request.ends_with_this) m_end_with_this.push_back(request.title);
      m_news = tr("{} is starting ...", request.title);
      m_refused = false;
    } catch (const core::EnvironmentLacks& lacks) {
      m_news = tr("{}: {}", request.title, lacks.what());
      m_refused = true;
    }
  }
  m_fresh = true;
}

void Children::poll(double now) {
  if (m_fresh) m_news_since = now;
  m_fresh = false;
  if (!m_refused && now > m_news_since + kNewsTime) m_news.clear();
  for (auto it = m_running.begin(); it != m_running.end();) {
    m_outputs[it->first] = it->second.output();
    if (it->second.running()) {
      ++it;
      continue;
    }
    ended(it->first, it->second);
    it = m_running.erase(it);
  }
}

void Children::ended(const std::string& title, ChildProgram& child) {
  const std::string errors = child.errors();
  const int status = child.exit_status().value_or(0);
  m_outputs[title] = child.output();
  if (!refused_with(status, errors)) {
    if (!m_refused) m_news.clear();
    return;
  }
  m_news = tr("{} could not run (exit status {}):\n{}", title, status, last_lines(errors, kMostLines));
  m_refused = true;
}

void Children::stop(const std::string& title) {
  if (const auto child = m_running.find(title); child != m_running.end()) child->second.ask_to_end();
}

std::string Children::output(const std::string& title) const {
  const auto found = m_outputs.find(title);
  return found == m_outputs.end() ? "" : found->second;
}

}  // namespace trocar::app
