#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace cattaneo
{

const char *name(NodeState state)
{
   switch (state)
   {
   case NodeState::stick:
      return "stick";
   case NodeState::separation:
      return "separation";
   case NodeState::forward_slip:
      return "forward slip";
   case NodeState::backward_slip:
      return "backward slip";
   case NodeState::slip:
      return "slip";
   }
   return "";
}

Eigen::VectorXd ContactState::displacements() const
{
   Eigen::VectorXd u(v.size() + w.size());
   u << v, w;
   return u;
}

Eigen::VectorXd ContactState::forces() const
{
   Eigen::VectorXd F(q.size() + p.size());
   F << q, p;
   return F;
}

namespace
{

void require_held(const ReducedProblem &problem, const Eigen::VectorXd &v, double allowed)
{
   for (Eigen::Index row : problem.held)
   {
      require(std::abs(v[row]) <= allowed, "contact state: row ", row, " of the slip is ",
              v[row], ", must be 0: it is held");
   }
}

/// What is not a number would be written as null.
void require_finite(const ContactState &state)
{
   bool finite = std::isfinite(state.time) && std::isfinite(state.step) &&
                 std::isfinite(state.peak_force) && std::isfinite(state.dissipation);
   for (const Eigen::VectorXd *all :
        {&state.v, &state.w, &state.q, &state.p, &state.slip_origin, &state.multipliers})
   {
      finite = finite && all->allFinite();
   }
   for (const Eigen::VectorXd &slip : state.cycle_slip) { finite = finite && slip.allFinite(); }
   require(finite, "contact state: a value is not finite");
}

} // namespace

ContactState ContactState::virgin(const ReducedProblem &problem)
{
   return with_slip(problem, Eigen::VectorXd::Zero(problem.slips()));
}

ContactState ContactState::with_slip(const ReducedProblem &problem, const Eigen::VectorXd &v)
{
   const Eigen::Index n = problem.nodes();
   require(v.size() == problem.slips(), "contact state: initial slip has ", v.size(),
           " entries, must be ", problem.slips());
   require_held(problem, v, 0);
   ContactState state;
   state.v = v;
   state.slip_origin = v;
   state.w = Eigen::VectorXd::Zero(n);
   state.q = Eigen::VectorXd::Zero(problem.slips());
   state.p = Eigen::VectorXd::Zero(n);
   state.status.resize(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      state.status[i] = problem.gap[i] > 0 ? NodeState::separation : NodeState::stick;
   }
   state.multipliers = Eigen::VectorXd::Zero(problem.patterns.size());
   return state;
}

void ContactState::validate(const ReducedProblem &problem) const
{
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   require(v.size() == m && q.size() == m && slip_origin.size() == m && w.size() == n &&
              p.size() == n && static_cast<Eigen::Index>(status.size()) == n &&
              multipliers.size() == patterns,
           "contact state: it has ", status.size(), " nodes and ", multipliers.size(),
           " load multipliers, the reduced problem has ", n, " nodes and ", patterns,
           " load patterns");
   for (const Eigen::VectorXd &slip : cycle_slip)
   {
      require(slip.size() == m, "contact state: the slip at the end of a cycle has ",
              slip.size(), " entries, must be ", m);
   }
   require_finite(*this);
   require_held(problem, v, m > 0 ? 1e-9 * v.cwiseAbs().maxCoeff() : 0);
}

namespace
{

const char *const format_name = "cattaneo contact state 1";

std::vector<double> list(const Eigen::VectorXd &x)
{
   return {x.data(), x.data() + x.size()};
}

Eigen::VectorXd vector(const nlohmann::json &j)
{
   const auto values = j.get<std::vector<double>>();
   return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

} // namespace

void save(const ContactState &state, const std::string &file)
{
   require_finite(state);
   std::vector<int> status;
   for (NodeState s : state.status) { status.push_back(static_cast<int>(s)); }
   std::vector<std::vector<double>> cycle_slip;
   for (const Eigen::VectorXd &v : state.cycle_slip) { cycle_slip.push_back(list(v)); }
   const nlohmann::json j = {{"format", format_name},
                             {"time", state.time},
                             {"step", state.step},
                             {"peak_force", state.peak_force},
                             {"dissipation", state.dissipation},
                             {"multipliers", list(state.multipliers)},
                             {"status", status},
                             {"cycle_slip", cycle_slip},
                             {"slip_origin", list(state.slip_origin)},
                             {"v", list(state.v)},
                             {"w", list(state.w)},
                             {"q", list(state.q)},
                             {"p", list(state.p)}};
   write_whole(file, j.dump(1) + '\n');
}

ContactState load_contact_state(const std::string &file)
{
   std::ifstream in(file);
   require(in.good() && !std::filesystem::is_directory(file),
           "contact state: cannot read file '", file, "'");
   try
   {
      const nlohmann::json j = nlohmann::json::parse(in);
      require(j.at("format") == format_name, "contact state: file '", file, "' has format ",
              j.at("format").dump(), ", must be \"", format_name, "\"");
      ContactState state;
      state.time = j.at("time");
      state.step = j.at("step");
      state.peak_force = j.at("peak_force");
      state.dissipation = j.at("dissipation");
      state.multipliers = vector(j.at("multipliers"));
      for (int s : j.at("status").get<std::vector<int>>())
      {
         require(s >= 0 && s <= 4, "contact state: status ", s, " in file '", file,
                 "', must be 0 to 4");
         state.status.push_back(static_cast<NodeState>(s));
      }
      for (const nlohmann::json &v : j.at("cycle_slip"))
      {
         state.cycle_slip.push_back(vector(v));
      }
      state.slip_origin = vector(j.at("slip_origin"));
      state.v = vector(j.at("v"));
      state.w = vector(j.at("w"));
      state.q = vector(j.at("q"));
      state.p = vector(j.at("p"));
      return state;
   }
   catch (const nlohmann::json::exception &e)
   {
      throw InputError("contact state: file '" + file +
                       "' is not a contact state: " + e.what());
   }
}

} // namespace cattaneo
