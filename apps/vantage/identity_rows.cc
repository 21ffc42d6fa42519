// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "identity_rows.h"

#include <fmt/format.h>

namespace vantage::app {

std::vector<ReportRow> IdentityRows(const IdentityReport& report) {
  if (report.appearances == 0) return {};
  if (!report.learnt) {
    return {{"identity", "too few people seen apart to tell them by colours"}};
  }
  return {{"identity", fmt::format("{} exchanges by colours at {} meetings",
                                   report.exchanges.size(), report.meetings)}};
}

}  // namespace vantage::app
