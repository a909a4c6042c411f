#pragma once

#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/joints/modal_loop.hpp>
#include <cattaneo/joints/vibration.hpp>
#include <functional>
#include <string>
#include <vector>

namespace miniapp
{

/// Options and tables of the modes of a joint, and of their frequency and damping against
/// amplitude.
class ModalCurves
{
public:
   /// @param modes   number of modes unless option --modes gives another; 0: none
   /// @param points  has the study named points, at which amplitudes may be given?
   explicit ModalCurves(Study &study, int modes = 3, bool points = true);
   /// Number of modes.
   int modes() const { return modes_; }
   /// To be called after parsing. InputError naming the option.
   void check_options();

   /// Finds and prints the modes about a state.
   cattaneo::Modes report_modes(const cattaneo::VibratingStructure &structure,
                                const cattaneo::ReducedProblem &problem,
                                const cattaneo::ContactState &state, const JointCase &joint);
   /// Finds, prints and draws the loops of all modes at all amplitudes. The exit code of the
   /// study is 2 if a loop was not found for another reason than that the joint slides.
   void report_loops(const cattaneo::VibratingStructure &structure,
                     const cattaneo::Modes &modes, const Scene &scene, const JointCase &joint,
                     const cattaneo::ContactState &state);

   /// In space: draws the losses of the nodes of an interface in a loop. Modes count from 1.
   std::function<void(Eigen::Index mode, const std::string &title,
                      const cattaneo::InterfaceReport &face, const cattaneo::ModalLoop &loop)>
      draw_losses;

private:
   /// The mode of a row, its glued frequency, its displacement at the point, whether there is a
   /// steady loop of the requested size, and whether it was marched by increments.
   struct Row
   {
      Eigen::Index mode;
      double glued, at_point;
      bool known, by_increments;
      nlohmann::ordered_json bolts; ///< by name: force that each has lost
   };
   /// The label of the axis of amplitudes.
   double drawn_size(const cattaneo::ModalLoop &loop, double at_point) const;
   void row(ResultTable &table, const cattaneo::ModalLoop &loop, double size, const Row &of,
            const std::vector<cattaneo::InterfaceReport> &faces);

   Study &study_;
   int modes_, count_ = 10;
   double shown_ = none;
   std::string amplitudes_, kind_ = "modal", at_;
   std::vector<double> stated_; ///< amplitudes of the options
};

} // namespace miniapp
