#pragma once

#include "arguments.hpp"
#include <cattaneo/friction/friction_solver.hpp>

// Members that several classes have.

namespace cattaneo::python
{

/// A value: copy(), and what the module copy asks for.
template <class T>
void bind_copies(nb::class_<T> &value, const char *doc = "")
{
   const auto copied = [](const T &self) { return T(self); };
   value.def("copy", copied, doc)
      .def("__copy__", copied)
      .def(
         "__deepcopy__", [](const T &self, nb::object) { return T(self); }, arg("memo"));
}

/// What must fit a problem.
template <class T>
void bind_validate(nb::class_<T> &value)
{
   value.def(
      "validate",
      [](const T &self, Of<ReducedProblem> problem)
      { self.validate(given(problem, "problem")); },
      arg("problem"), "InputError unless it is one of the problem.");
}

/// How marching ended. `report` gives what has a status and a message.
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

/// Refuses what is neither a function nor None.
inline void require_observer(nb::handle observer)
{
   if (!observer.is_none() && PyCallable_Check(observer.ptr()) == 0)
   {
      refuse(observer, "observer", "a function or None");
   }
}

} // namespace cattaneo::python
