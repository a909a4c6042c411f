#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/readout/zones.hpp>
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
   const bool disc = problem.components() == 2;
   out << (disc ? ",stick,separation,slip" : ",stick,separation,forward_slip,backward_slip")
       << ",dissipation,external_work,residual_normal,residual_tangential,round_off\n";
   for (const auto &[record, multipliers] : rows_)
   {
      require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
              "history table: a state has ", multipliers.size(),
              " load multipliers, the problem ", problem.patterns.size(), " load patterns");
      out << record.time << ',' << record.cycle;
      for (double multiplier : multipliers) { out << ',' << multiplier; }
      out << ',' << record.stick << ',' << record.separation << ',';
      if (disc) { out << record.slip; }
      else { out << record.forward_slip << ',' << record.backward_slip; }
      out << ',' << record.dissipation << ',' << record.external_work << ','
          << record.residual_normal << ',' << record.residual_tangential << ','
          << record.round_off << '\n';
   }
   write_whole(file, out.str());
}

void write_nodes(const std::string &file, const ReducedProblem &problem,
                 const std::vector<ContactState> &states)
{
   const Eigen::Index n = problem.nodes();
   require(problem.arc_length.size() == n && problem.position.rows() == n,
           "node table: the reduced problem has no arc length or positions");
   std::ostringstream out;
   out.precision(17);
   const bool disc = problem.components() == 2;
   out << "time,node,arc_length,x,y,state,p,"
       << (disc ? "q_radial,q_circumferential,slip_radial,slip_circumferential" : "q,slip")
       << ",opening\n";
   for (const ContactState &state : states)
   {
      state.validate(problem);
      const Eigen::VectorXd p = tractions(problem, state.p);
      // Without tangential components: zeros in one column.
      const Eigen::Index columns = std::max<Eigen::Index>(problem.components(), 1);
      Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n, columns), slip = q;
      for (Eigen::Index k = 0; k < problem.components(); ++k)
      {
         q.col(k) = tractions(problem, state.q.segment(k * n, n));
         slip.col(k) = state.v.segment(k * n, n);
      }
      const std::vector<NodeState> settled = settled_states(problem, state);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         out << state.time << ',' << i << ',' << problem.arc_length[i] << ','
             << problem.position(i, 0) << ',' << problem.position(i, 1) << ','
             << name(settled[i]) << ',' << p[i];
         for (Eigen::Index k = 0; k < columns; ++k) { out << ',' << q(i, k); }
         for (Eigen::Index k = 0; k < columns; ++k) { out << ',' << slip(i, k); }
         out << ',' << state.w[i] + problem.gap[i] << '\n';
      }
   }
   write_whole(file, out.str());
}

} // namespace cattaneo
