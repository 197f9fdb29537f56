// A study of many attempts as a page for people: one HTML file with its drawings inside, which opens without a network.
#pragma once

#include <string>

#include <trocar/training/metrics/study.hpp>

namespace trocar::reports {

/// @param title    plain text
/// @param remarks  paragraphs that say where the attempts come from and what to mind, plain text
std::string trials_html(const training::Study& study, const std::string& title,
                        const std::vector<std::string>& remarks);

}  // namespace trocar::reports
