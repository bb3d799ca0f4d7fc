#include "mesher/base/control.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

namespace delmesher::base {
namespace {

Status status_with(std::function<bool(const Progress&)> progress) {
  Limits options;
  options.progress = std::move(progress);
  Control control(options);
  try {
    control.enter(Phase::check);
  } catch (const Stopped& stopped) {
    return stopped.status;
  }
  return {};
}

TEST(Control, WhatTheCallbackThrowsInterrupts) {
  EXPECT_TRUE(status_with([](const Progress&) { return true; }).ok());
  EXPECT_EQ(status_with([](const Progress&) { return false; }).message, "interrupted");
  const Status known =
      status_with([](const Progress&) -> bool { throw std::runtime_error("no more"); });
  EXPECT_EQ(known.code, StatusCode::interrupted);
  EXPECT_EQ(known.message, "interrupted: the progress callback threw: no more");
  const Status unknown = status_with([](const Progress&) -> bool { throw 3; });
  EXPECT_EQ(unknown.code, StatusCode::interrupted);
  EXPECT_EQ(unknown.message, "interrupted: the progress callback threw what is no std::exception");
}

TEST(Control, MemoryIsALimitInTheCallbackToo) {
  EXPECT_THROW(status_with([](const Progress&) -> bool { throw std::bad_alloc(); }),
               std::bad_alloc);
}

}  // namespace
}  // namespace delmesher::base
