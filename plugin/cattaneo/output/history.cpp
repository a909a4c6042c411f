#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>
#include <cstdlib>
#include <sstream>
#include <vector>

namespace cattaneo
{

namespace
{

bool has_disc(const ReducedProblem &problem)
{
   return problem.components() == 2;
}

/// Sizes of the resultants of the loads at multiplier 1; 0 of those that have none or whose
/// size is not known.
Eigen::VectorXd resultants(const ReducedProblem &problem)
{
   Eigen::VectorXd sizes = Eigen::VectorXd::Zero(problem.patterns.size());
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoadSize &size = problem.patterns[k].size;
      for (const char *kind :
           {"force", "opposite forces", "displacement", "moment", "torque", "rotation", "bolt"})
      {
         if (size.kind == kind) { sizes[static_cast<Eigen::Index>(k)] = size.value; }
      }
   }
   return sizes;
}

std::string history_header(const ReducedProblem &problem)
{
   std::string loads, conjugates;
   const Eigen::VectorXd sizes = resultants(problem);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      require(pattern.name.find_first_of("\n\r") == std::string::npos,
              "history table: load pattern '", pattern.name, "' has a line break in its name");
      loads += ',' + csv_field("load " + pattern.name);
      const std::string conjugate =
                           pattern.control == Control::force ? "displacement " : "reaction ",
                        per = sizes[static_cast<Eigen::Index>(k)] > 0 ? "" : "per unit of ";
      conjugates += ',' + csv_field((problem.knows_loads() ? "" : "contact ") + conjugate +
                                    per + pattern.name);
   }
   return "time,cycle" + loads +
          (has_disc(problem) ? ",stick,separation,slip"
                             : ",stick,separation,forward_slip,backward_slip") +
          ",dissipation,total_dissipation,external_work,residual_normal,residual_tangential,"
          "round_off" +
          conjugates + ",found_by,event";
}

std::string history_row(const IncrementRecord &record, double lost,
                        const Eigen::VectorXd &sizes, bool disc)
{
   const Eigen::Index patterns = sizes.size();
   require(record.multipliers.size() == patterns && record.conjugates.size() == patterns,
           "history table: a record has ", record.multipliers.size(),
           " load multipliers, must have one for each of the ", patterns, " load patterns");
   std::ostringstream out;
   out.precision(17);
   out << record.time << ',' << record.cycle;
   for (double multiplier : record.multipliers) { out << ',' << multiplier; }
   out << ',' << record.stick << ',' << record.separation << ',';
   if (disc) { out << record.slip; }
   else { out << record.forward_slip << ',' << record.backward_slip; }
   out << ',' << record.dissipation << ',' << lost << ',' << record.external_work << ','
       << record.residual_normal << ',' << record.residual_tangential << ','
       << record.round_off;
   for (Eigen::Index k = 0; k < patterns; ++k)
   {
      out << ',' << (sizes[k] > 0 ? record.conjugates[k] / sizes[k] : record.conjugates[k]);
   }
   out << ',' << csv_field(record.found_by) << ',' << record.event << '\n';
   return out.str();
}

/// Refuses to continue a file whose last row has another time or other multipliers than the
/// state. A row begins with time and cycle, followed by the multipliers.
void check_goes_on(const std::string &file, const std::string &last, const ContactState &from)
{
   std::vector<double> row;
   std::istringstream line(last);
   for (std::string cell; std::getline(line, cell, ',');)
   {
      row.push_back(std::strtod(cell.c_str(), nullptr));
   }
   const auto patterns = from.multipliers.size();
   const bool same =
      static_cast<Eigen::Index>(row.size()) >= patterns + 2 && row[0] == from.time &&
      Eigen::Map<const Eigen::VectorXd>(row.data() + 2, patterns) == from.multipliers;
   require(
      same, "file '", file, "' cannot be continued: its last row up to time ", from.time,
      " is '", last,
      "', not the state from which the march continues: the file belongs to another march");
}

} // namespace

HistoryWriter::HistoryWriter(const std::string &file, const ReducedProblem &problem)
   : sizes_(resultants(problem)), disc_(has_disc(problem)), file_(file, history_header(problem))
{
}

HistoryWriter::HistoryWriter(const std::string &file, const ReducedProblem &problem,
                             const ContactState &from)
   : sizes_(resultants(problem)), disc_(has_disc(problem)),
     file_(file, history_header(problem), from.time,
           [&](const std::string &last) { check_goes_on(file, last, from); })
{
}

void HistoryWriter::add(const ContactState &state, const IncrementRecord &record)
{
   file_.add(history_row(record, state.dissipation, sizes_, disc_));
}

namespace
{

/// Number of interfaces. Chains of one interface follow each other.
int interfaces(const ReducedProblem &problem)
{
   int count = 0;
   const std::string *last = nullptr;
   for (const ContactChain &chain : problem.chains)
   {
      count += !last || chain.interface != *last;
      last = &chain.interface;
   }
   return count;
}

/// Are its nodes those of a surface, without an arc length?
bool in_space(const ReducedProblem &problem)
{
   return problem.arc_length.size() == 0 && problem.position.cols() == 3;
}

std::string node_header(const ReducedProblem &problem,
                        const std::vector<std::string> &interface_of)
{
   require(interface_of.empty() ||
              (interface_of.size() == std::size_t(problem.nodes()) && interfaces(problem) == 0),
           "node table: names of interfaces for ", interface_of.size(), " nodes, must be for ",
           problem.nodes(), " nodes of surfaces");
   require((in_space(problem) || problem.arc_length.size() == problem.nodes()) &&
              problem.position.rows() == problem.nodes() &&
              problem.weights.size() == problem.nodes(),
           "node table: the reduced problem must have arc lengths, positions and weights");
   const bool several = interfaces(problem) > 1 || !interface_of.empty();
   return std::string("time,node,") + (several ? "interface," : "") +
          (in_space(problem) ? "x,y,z" : "arc_length,x,y") + ",state,p," +
          (has_disc(problem) ? "q1,q2,slip1,slip2" : "q,slip") + ",opening" +
          (in_space(problem) ? ",area" : "");
}

std::string node_rows(const ReducedProblem &problem, const ContactState &state,
                      const std::vector<std::string> &interface_of)
{
   state.validate(problem);
   const Eigen::Index n = problem.nodes();
   const Eigen::VectorXd p = tractions(problem, state.p);
   // A problem without tangential components gets one column of zeros.
   const Eigen::Index columns = std::max<Eigen::Index>(problem.components(), 1);
   Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n, columns), slip = q;
   for (Eigen::Index k = 0; k < problem.components(); ++k)
   {
      q.col(k) = tractions(problem, state.q.segment(k * n, n));
      slip.col(k) = state.v.segment(k * n, n);
   }
   const std::vector<NodeState> settled = settled_states(problem, state);
   const bool several = interfaces(problem) > 1;
   std::size_t chain = 0;
   std::ostringstream out;
   out.precision(17);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      out << state.time << ',' << i << ',';
      while (several && i >= problem.chains[chain].first + problem.chains[chain].nodes)
      {
         ++chain;
      }
      if (several) { out << csv_field(problem.chains[chain].interface) << ','; }
      if (!interface_of.empty()) { out << csv_field(interface_of[i]) << ','; }
      if (!in_space(problem)) { out << problem.arc_length[i] << ','; }
      out << problem.position(i, 0) << ',' << problem.position(i, 1) << ',';
      if (in_space(problem)) { out << problem.position(i, 2) << ','; }
      out << name(settled[i]) << ',' << p[i];
      for (Eigen::Index k = 0; k < columns; ++k) { out << ',' << q(i, k); }
      for (Eigen::Index k = 0; k < columns; ++k) { out << ',' << slip(i, k); }
      out << ',' << state.w[i] + problem.gap[i];
      if (in_space(problem)) { out << ',' << problem.weights[i]; }
      out << '\n';
   }
   return out.str();
}

} // namespace

NodeWriter::NodeWriter(const std::string &file, const ReducedProblem &problem,
                       std::vector<std::string> interface_of)
   : problem_(problem), interface_of_(std::move(interface_of)),
     file_(file, node_header(problem, interface_of_))
{
}

NodeWriter::NodeWriter(const std::string &file, const ReducedProblem &problem, double time,
                       std::vector<std::string> interface_of)
   : problem_(problem), interface_of_(std::move(interface_of)),
     file_(file, node_header(problem, interface_of_), time)
{
}

void NodeWriter::add(const ContactState &state)
{
   file_.add(node_rows(problem_, state, interface_of_));
}

StateSaver::StateSaver(const std::string &file, double seconds) : file_(file), seconds_(seconds)
{
   require_at_least("state saver: seconds", seconds, 0);
   require_writable(file);
}

void StateSaver::add(const ContactState &state, const IncrementRecord &record)
{
   const auto now = std::chrono::steady_clock::now();
   const double passed = std::chrono::duration<double>(now - last_).count();
   if (passed < (record.resumes ? 1 : 2) * seconds_) { return; }
   save(state, file_);
   last_ = now;
}

} // namespace cattaneo
