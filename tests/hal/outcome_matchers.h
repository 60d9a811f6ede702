// What a failure has to say: its status, and each of the given pieces in its sentence.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

inline testing::AssertionResult succeeds(const Outcome& o) {
  if (o.ok() && o.message.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << to_string(o.status) << ": " << o.message;
}

inline testing::AssertionResult fails(const Outcome& o, Status status, std::initializer_list<std::string_view> pieces) {
  if (o.status != status)
    return testing::AssertionFailure() << "status is " << to_string(o.status) << ": " << o.message;
  for (const std::string_view piece : pieces)
    if (o.message.find(piece) == std::string::npos)
      return testing::AssertionFailure() << "'" << piece << "' is not in: " << o.message;
  return testing::AssertionSuccess();
}

// Whether one of the sentences holds all pieces.
inline testing::AssertionResult says(const std::vector<std::string>& sentences,
                                     std::initializer_list<std::string_view> pieces) {
  for (const std::string& sentence : sentences) {
    bool all = true;
    for (const std::string_view piece : pieces) all = all && sentence.find(piece) != std::string::npos;
    if (all) return testing::AssertionSuccess();
  }
  auto failure = testing::AssertionFailure() << "not said by any of " << sentences.size() << ":";
  for (const std::string& sentence : sentences) failure << "\n  " << sentence;
  return failure;
}

}  // namespace accrete::hal
