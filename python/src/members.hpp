#pragma once

#include "arguments.hpp"
#include <cattaneo/friction/friction_solver.hpp>
#include <functional>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

// Members that several classes share.

namespace cattaneo::python
{

/// For values: copy(), and the functions that the module copy calls.
template <class T>
void bind_copies(nb::class_<T> &value, const char *doc = "")
{
   const auto copied = [](const T &self) { return T(self); };
   value.def("copy", copied, *doc ? doc : "Another one with the same values.")
      .def("__copy__", copied)
      .def(
         "__deepcopy__", [](const T &self, nb::object) { return T(self); }, arg("memo"));
}

/// For objects that must fit a problem.
template <class T>
void bind_validate(nb::class_<T> &value)
{
   value.def(
      "validate", [](const T &self, const ReducedProblem &problem) { self.validate(problem); },
      arg("problem"), "InputError unless it is one of the problem.");
}

/// A getter that applies `get` to each entry of a member and returns a list.
template <class T, class Range, class Get>
auto each_of(Range T::*range, Get get)
{
   return [range, get](const T &self)
   {
      std::vector<std::decay_t<decltype(std::invoke(get, *(self.*range).begin()))>> all;
      for (const auto &each : self.*range) { all.push_back(std::invoke(get, each)); }
      return all;
   };
}

/// References to entries of an object, which keep it alive.
template <class T, class Range, class Get>
nb::list references(T &self, Range &range, Get get)
{
   nb::list all;
   for (auto &each : range)
   {
      all.append(
         nb::cast(std::invoke(get, each), nb::rv_policy::reference_internal, nb::find(self)));
   }
   return all;
}

/// The outcome of a march. `report` returns an object with a status and a message.
template <class T, class Report>
void bind_outcome(nb::class_<T> &value, Report report)
{
   value
      .def_prop_ro(
         "status", [report](const T &self) { return name(report(self).status); },
         "'converged', 'gross sliding', 'not unique', 'no solution', 'stalled' or "
         "'stopped'")
      .def_prop_ro("converged", [report](const T &self)
                   { return report(self).status == FrictionStatus::converged; })
      .def_prop_ro("message", [report](const T &self) { return report(self).message; });
}

} // namespace cattaneo::python
