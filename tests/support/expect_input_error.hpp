#pragma once

#include <cattaneo/input_error.hpp>
#include <functional>
#include <gtest/gtest.h>
#include <string>

/// `act` is refused with a sentence that says `part`.
void expect_input_error(const std::function<void()> &act, const std::string &part);
