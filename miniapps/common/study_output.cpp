#include "common/study_output.hpp"

#include <cattaneo/reduced/reduced_file.hpp>
#include <iostream>

namespace miniapp
{

void add_save_option(Options &args, const char **file)
{
   args.add(Options::Names::output, file, "-save", "--save",
            "File for the reduced problem (shakedown --reduced reads it).");
}

void StudyOutput::add_options(Options &args)
{
   args.add(Options::Names::output, &json_, "-json", "--json", "File for the results.");
   args.add(Options::Names::prefix, &csv_, "-csv", "--csv",
            "Prefix of CSV files for the figures.");
   args.add(Options::Names::picture, &plot_, "-plot", "--plot",
            "Picture of the results (png, pdf, svg).");
   add_save_option(args, &save_);
}

void StudyOutput::reduced(const cattaneo::ReducedProblem &problem, int dofs)
{
   nodes_ = problem.nodes();
   dofs_ = dofs;
   const Eigen::Index unknowns = (problem.components() + 1) * nodes_;
   seconds_ = watch_.seconds();
   std::cout << "Condensed " << dofs << " dofs to " << unknowns << " in " << seconds_ << " s"
             << std::endl;
   if (*save_ && writes()) { save(problem, save_); }
}

void StudyOutput::write(nlohmann::ordered_json &results, const cattaneo::Counters &counters,
                        const ReferenceTable &table, const std::vector<Panel> &panels) const
{
   table.print();
   results["contact_nodes"] = nodes_;
   results["dofs"] = dofs_;
   results["seconds"] = watch_.seconds();
   results["seconds_condensation"] = seconds_;
   results["counters"] = to_json(counters);
   results["references"] = table.json();
   write_json(results, json_);
   output(panels, csv_, plot_);
}

} // namespace miniapp
