#pragma once

#include <gtest/gtest.h>

#include <string>

#include "pillarfield/error.h"

namespace pillarfield::core_test {

/// Message of the Error that `action` throws; fails the test if it throws none.
template <class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

}  // namespace pillarfield::core_test
