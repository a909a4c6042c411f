#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include <cattaneo/friction/settled_states.hpp>
#include <nanobind/stl/string.h>
#include <sstream>

// States of a contact.

namespace cattaneo::python
{

States state_numbers(const std::vector<NodeState> &states)
{
   return array<States>(Eigen::Matrix<signed char, Eigen::Dynamic, 1>(
      Eigen::Map<const Eigen::Matrix<signed char, Eigen::Dynamic, 1>>(
         reinterpret_cast<const signed char *>(states.data()),
         static_cast<Index>(states.size()))));
}

void bind_states(nb::module_ &m)
{
   nb::enum_<NodeState>(m, "NodeState", nb::is_arithmetic(), "State of a contact node.")
      .value("stick", NodeState::stick)
      .value("separation", NodeState::separation)
      .value("forward_slip", NodeState::forward_slip, "q = -f p")
      .value("backward_slip", NodeState::backward_slip, "q = +f p")
      .value("slip", NodeState::slip,
             "with two tangential components: q = -f p v'/|v'|; of settled_states() also "
             "without friction");

   using Self = ContactState;
   nb::class_<Self> state(m, "ContactState",
                          "The state of a frictional contact: all data on which its future "
                          "depends. Arrays are read-only views.");
   bind_validate(state);
   bind_copies(state);
   state
      .def_static("virgin", &Self::virgin, arg("problem"),
                  "A state of the problem before any load.")
      .def_static(
         "with_slip",
         [](const ReducedProblem &problem, Numbers v)
         { return Self::with_slip(problem, vector(v, "v", problem.slips())); },
         arg("problem"), arg("v"),
         "The state before any load, with a given slip. v: (c n,), slip of the nodes of the "
         "problem.")
      .def_prop_ro("v", viewed(&Self::v), "slip, size c n")
      .def_prop_ro("w", viewed(&Self::w), "opening, size n")
      .def_prop_ro("q", viewed(&Self::q), "tangential nodal forces, size c n")
      .def_prop_ro("p", viewed(&Self::p), "normal nodal forces, compression positive, size n")
      .def_prop_ro("slip_origin", viewed(&Self::slip_origin),
                   "slip at which each node last stuck, opened or reversed")
      .def_prop_ro("multipliers", viewed(&Self::multipliers), "of the load patterns")
      .def_prop_ro(
         "status", [](const Self &self) { return state_numbers(self.status); },
         "NodeState of each node, as the solver left it; see settled_states()")
      .def_ro("time", &Self::time, "of the load history")
      .def_ro("dissipation", &Self::dissipation, "frictional energy lost so far")
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;

              text << "<ContactState at time " << self.time << ": normal force " << self.p.sum()
                   << ", tangential force " << self.q.sum() << ", dissipation "
                   << self.dissipation << ", " << self.p.size() << " nodes>";
              return text.str();
           });
   m.def(
      "load_contact_state", [](File name) { return load_contact_state(file(name)); },
      arg("file"),
      "Reads a state from a file that save(), or a program with --save-state, wrote.");
   m.def(
      "settled_states",
      [](const ReducedProblem &problem, const Self &state)
      {
         state.validate(problem);
         return state_numbers(settled_states(problem, state));
      },
      arg("problem"), arg("state"),
      "NodeState of each node of a state of the problem, with ties decided by mechanics, not "
      "by round-off.");
}

} // namespace cattaneo::python
