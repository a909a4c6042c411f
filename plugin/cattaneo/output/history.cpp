#include <cattaneo/friction/zones.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/whole_file.hpp>
#include <sstream>

namespace cattaneo
{

void HistoryTable::add(const ContactState &state, const IncrementRecord &record)
{
   rows_.push_back({record, state.multipliers});
}

void HistoryTable::write(const std::string &file, const ReducedProblem &problem) const
{
   std::ostringstream out;
   out.precision(17);
   out << "time,cycle";
   for (const LoadPattern &pattern : problem.patterns)
   {
      require(pattern.name.find_first_of(",\"\n\r") == std::string::npos,
              "history table: load pattern '", pattern.name,
              "' has a comma, a quote or a line break in its name");
      out << ",load " << pattern.name;
   }
   out << ",stick,separation,forward_slip,backward_slip,dissipation,external_work,"
          "residual_normal,residual_tangential\n";
   for (const auto &[record, multipliers] : rows_)
   {
      require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
              "history table: a state has ", multipliers.size(),
              " load multipliers, the problem ", problem.patterns.size(), " load patterns");
      out << record.time << ',' << record.cycle;
      for (double multiplier : multipliers) { out << ',' << multiplier; }
      out << ',' << record.stick << ',' << record.separation << ',' << record.forward_slip
          << ',' << record.backward_slip << ',' << record.dissipation << ','
          << record.external_work << ',' << record.residual_normal << ','
          << record.residual_tangential << '\n';
   }
   write_whole(file, out.str());
}

void write_nodes(const std::string &file, const ReducedProblem &problem,
                 const std::vector<ContactState> &states)
{
   const Eigen::Index n = problem.nodes();
   require(problem.components() <= 1, "node table: plane problems only, this one has ",
           problem.components(), " tangential components");
   require(problem.arc_length.size() == n && problem.position.rows() == n,
           "node table: the reduced problem has no arc length or positions");
   std::ostringstream out;
   out.precision(17);
   out << "time,node,arc_length,x,y,state,p,q,slip,opening\n";
   for (const ContactState &state : states)
   {
      state.validate(problem);
      const Eigen::VectorXd p = tractions(problem, state.p);
      const bool tangential = state.q.size() > 0;
      const Eigen::VectorXd q =
         tangential ? tractions(problem, state.q) : Eigen::VectorXd::Zero(n);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         out << state.time << ',' << i << ',' << problem.arc_length[i] << ','
             << problem.position(i, 0) << ',' << problem.position(i, 1) << ','
             << name(state.status[i]) << ',' << p[i] << ',' << q[i] << ','
             << (tangential ? state.v[i] : 0.0) << ',' << state.w[i] + problem.gap[i] << '\n';
      }
   }
   write_whole(file, out.str());
}

} // namespace cattaneo
