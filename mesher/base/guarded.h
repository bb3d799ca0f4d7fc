// The beginning and the end of the pipelines, in space and in the plane.
#pragma once

#include <exception>
#include <new>
#include <string>

#include "mesher/base/check.h"
#include "mesher/base/control.h"
#include "mesher/base/namespaces.h"
#include "mesher/delmesher/run.h"

namespace delmesher::base {

// Runs `body` and turns everything it may throw into a status: the public API reports errors as
// values.
template <class Body>
Status guarded(Control& control, Body&& body) {
  try {
    const Status status = body();
    control.finish();
    return status;
  } catch (const Stopped& stopped) {
    control.finish();
    return stopped.status;
  } catch (const InternalError& error) {
    return {StatusCode::internal_error, error.what()};
  } catch (const std::bad_alloc&) {
    return {StatusCode::limit_reached, "out of memory", Limit::memory};
  } catch (const std::exception& error) {
    return {StatusCode::internal_error, error.what()};
  } catch (...) {
    return {StatusCode::internal_error, "an exception of an unknown type"};
  }
}

}  // namespace delmesher::base
