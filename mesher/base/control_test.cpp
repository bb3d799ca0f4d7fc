#include "mesher/base/control.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "mesher/base/guarded.h"

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
  EXPECT_EQ(unknown.message,
            "interrupted: the progress callback threw what is not a std::exception");
}

TEST(Control, MemoryIsALimitInTheCallbackToo) {
  EXPECT_THROW(status_with([](const Progress&) -> bool { throw std::bad_alloc(); }),
               std::bad_alloc);
}

TEST(Guarded, TurnsAllThatIsThrownIntoAStatus) {
  const auto status_of = [](auto thrown) {
    const Limits options;
    Control control(options);
    return guarded(control, [&]() -> Status { throw thrown; });
  };
  const Stopped stopped{{StatusCode::limit_reached, "too many", Limit::size}};
  EXPECT_EQ(status_of(stopped).message, "too many");
  EXPECT_EQ(status_of(stopped).limit, Limit::size);
  EXPECT_EQ(status_of(InternalError("a law is broken")).code, StatusCode::internal_error);
  EXPECT_EQ(status_of(std::bad_alloc()).limit, Limit::memory);
  const Status other = status_of(std::runtime_error("what nobody expected"));
  EXPECT_EQ(other.code, StatusCode::internal_error);
  EXPECT_EQ(other.message, "what nobody expected");
  EXPECT_EQ(status_of(3).message, "an exception of an unknown type");
}

}  // namespace
}  // namespace delmesher::base
