// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace vantage {

/// Why an operation failed: one sentence that names the file, field or option, says what is wrong
/// and what would be right. Errors are values, each handled exactly once; the library neither
/// prints nor throws across its edge.
struct Error {
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

/// `return Fail("{}: no such file", path);`
template <class... Args>
[[nodiscard]] tl::unexpected<Error> Fail(fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected<Error>(Error{fmt::format(format, std::forward<Args>(args)...)});
}

}  // namespace vantage

#define VANTAGE_CONCAT_INNER(a, b) a##b
#define VANTAGE_CONCAT(a, b) VANTAGE_CONCAT_INNER(a, b)

/// Returns the error of a Status or Result expression to the caller.
#define VANTAGE_RETURN_IF_ERROR(expression)                                       \
  do {                                                                            \
    if (auto vantage_status = (expression); !vantage_status) {                    \
      return tl::unexpected<::vantage::Error>(std::move(vantage_status).error()); \
    }                                                                             \
  } while (false)

/// `VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(path));`
#define VANTAGE_ASSIGN_OR_RETURN(declaration, expression) \
  VANTAGE_ASSIGN_OR_RETURN_IMPL(VANTAGE_CONCAT(vantage_result_, __LINE__), declaration, expression)
#define VANTAGE_ASSIGN_OR_RETURN_IMPL(result, declaration, expression)  \
  auto result = (expression);                                           \
  if (!result) {                                                        \
    return tl::unexpected<::vantage::Error>(std::move(result).error()); \
  }                                                                     \
  declaration = std::move(*result)
