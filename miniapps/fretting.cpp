//  fretting: will a crack grow from the edge of this contact? Slip, yield, threshold and energy
//
//  A constant force P presses a pad on a specimen. A shear force Q and a bulk stress in the
//  specimen cycle together between their peak and R times the peak. All this acts on the edge
//  of an incomplete contact only through two numbers: K_N, how fast the pressure rises, and
//  K_T, how strong the shear would be if nothing slipped. From them follow the slip zone, the
//  stresses, the growth of a crack normal to the surface, the Kitagawa-Takahashi verdict and
//  the frictional energy. The pad 'fe' finds the two numbers in a finite element solution of
//  the contact, and compares the slip zone and the energy of the formulas with those of this
//  solution. Multiaxial criteria on critical planes use the stresses of its steady cycle,
//  averaged over a depth.
//
//  Units: N, mm, MPa; forces per mm of thickness. Material data in GPa, MPa and MPa sqrt(m).
//
//  Sample runs:
//    fretting
//    fretting --normal-load 400 --radius 50 --shear-load 60 --bulk 80 --material Al
//       --friction 0.7
//    fretting --pad flat-rounded --radius 3 --flat 3 --normal-load 1000 --shear-load 20
//       --bulk 20 --material Ti6Al4V
//    fretting --pad kn --k-n 4000 --k-t 20 --friction 0.6 --young 115 --material Ti6Al4V
//    fretting --pad fe --shear-load 50
//    fretting --pad fe --shear-load 50 --bulk 30 --nodes 201
//    fretting --pad fe --shear-load 100 --averaging-depth 0.1
//    fretting --pad fe --radius 10 --flat 2 --normal-load 1000 --shear-load 100
//       --material Ti6Al4V --nodes 201
//    fretting --shear-load 5 --bulk 10 --plot fretting.png --csv fretting
//    fretting --plot fretting.svg --csv f --records miniapps/data/fretting_records.csv

#include "common/shipped.hpp"
#include "fretting/critical_planes.hpp"
#include "fretting/fretting_figures.hpp"
#include "fretting/fretting_page.hpp"
#include "fretting/pad.hpp"

#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/input_error.hpp>
#include <map>

using namespace cattaneo;
using namespace miniapp;
using namespace cattaneo::fretting;

namespace
{

const std::map<std::string, Criterion> criteria_by_name = {
   {"open", Criterion::open},
   {"range", Criterion::range},
   {"half-range", Criterion::half_range}};

/// Criteria on critical planes, where mesh and half-plane resolve the averaged stresses.
void judge_planes(Study &study, const Pad &pad, const PadContact &closed_form,
                  const SolvedPad &solved, double depth, const PlaneWeights &weights)
{
   // The edge of the contact lies anywhere in its element, so two coarser meshes have it at
   // other places.
   std::vector<SolvedPad> coarser;
   for (const int eighths : {4, 5})
   {
      Pad other = pad;
      other.nodes = pad.order * ((pad.nodes - 1) / pad.order * eighths / 8) + 1;
      coarser.push_back(solve(study, other, closed_form, false));
   }
   report_critical_planes(study, pad, solved, coarser, depth, weights);
}

void assess_pad(Study &study)
{
   Pad pad;
   std::string material = "Al", criterion = "open", records,
               material_file = shipped("miniapps/data/materials.json");
   PlaneWeights weights;
   double depth = none, young = none, poisson = none, threshold = none, limit = none,
          yield = none;
   study.options().group("The pad");
   study.option(&pad.kind, "pad",
                "hertz (cylinder on flat), flat-rounded, fe (either of these two, computed "
                "with finite elements of the contact on half-planes), or kn (K_N "
                "and K_T given).",
                {"hertz", "flat-rounded", "fe", "kn"});
   study.option(&pad.radius, "radius", "Radius of the pad or of its edges, mm.");
   study.option(&pad.flat, "flat", "Half width of the flat, mm (flat-rounded, fe).");
   study.options().group("The loads");
   study.option(&pad.normal, "normal-load", "Normal force, N/mm, constant (not for kn).");
   study.option(&pad.shear, "shear-load",
                "Shear force on the specimen at peak load, N/mm (not for kn).");
   study.option(&pad.bulk, "bulk",
                "Bulk stress in the specimen at peak load, MPa (default: it is left out, and a "
                "remark in the output says so).");
   study.option(&pad.bulk_pad, "bulk-pad", "Bulk stress in the pad at peak load, MPa.");
   study.option(&pad.load_ratio, "load-ratio",
                "Load ratio R of shear and bulk stress, least over peak value, -1 <= R < 1.");
   study.option(&pad.friction, "friction",
                "Friction coefficient (default: middle of the material's interval).", positive);
   study.options().group("The pad");
   study.option(&pad.k_n, "k-n", "K_N in MPa/sqrt(mm) (pad kn).");
   study.option(&pad.k_t, "k-t", "K_T at peak load in MPa sqrt(mm) (pad kn).");
   study.option(
      &pad.half_width, "half-width",
      "Half width of the contact, mm (pad kn; used only for the checks of validity).");
   study.options().group("Finite elements");
   study.option(
      &pad.nodes, "nodes",
      "Number of contact nodes (pad fe). For a pad with a flat: the number near its two edges "
      "together. The nodes on the flat between the edges come in addition.");
   study.option(&pad.order, "order", "Order of the elements (pad fe).", within(1, 8));
   study.option(
      &depth, "averaging-depth",
      "Evaluates criteria on critical planes along the surface, with stresses averaged over "
      "this depth in mm (pad fe; from the spacing of its nodes to the half-width of contact).",
      positive);
   study.options().group("The criteria");
   study.option(&weights.findley, "findley",
                "k of Findley's criterion (with --averaging-depth).", not_negative);
   study.option(&weights.fatemi_socie, "fatemi-socie",
                "k of Fatemi and Socie's (with --averaging-depth).", not_negative);
   study.options().group("The material");
   study.option(&material, "material", "Name of a material record.");
   study.option(&material_file, "material-file", "File of material records, JSON.",
                Text::input);
   study.option(&young, "young", "Young's modulus, GPa (default: the record's).",
                Check{[](double E) { return E > 0 && E < 2000; },
                      "must be positive and below 2000 (GPa, not MPa)"});
   study.option(&poisson, "poisson", "Poisson's ratio (default: the record's).");
   study.option(
      &threshold, "threshold",
      "Threshold dK_th, MPa sqrt(m): a range or an amplitude, whichever the material's "
      "record has. The same holds for --fatigue-limit.",
      positive);
   study.option(&limit, "fatigue-limit", "Plain fatigue limit, MPa.");
   study.option(&yield, "shear-yield", "Yield stress in pure shear, MPa.");
   study.option(&pad.plane_stress, {"plane-stress", "plane-strain"},
                "Plane stress or plane strain.");
   study.options().group("The criteria");
   study.option(&criterion, "criterion",
                "Part of K_I that drives the crack: open (the part of the cycle in which it is "
                "open), range, or half-range.",
                {"open", "range", "half-range"});
   study.option(
      &records, "records",
      "CSV file of tests (P, Q, material, ..., cycles, runout): edge stress, threshold, range "
      "of K_T and energies are computed for each test and compared with its life.",
      Text::input);
   study.options().renamed({{"p", "pad"},
                            {"r", "radius"},
                            {"b", "flat"},
                            {"P", "normal-load"},
                            {"Q", "shear-load"},
                            {"bs", "bulk"},
                            {"bp", "bulk-pad"},
                            {"lr", "load-ratio"},
                            {"f", "friction"},
                            {"kn", "k-n"},
                            {"kt", "k-t"},
                            {"a", "half-width"},
                            {"ad", "averaging-depth"},
                            {"m", "material"},
                            {"mf", "material-file"},
                            {"E", "young"},
                            {"nu", "poisson"},
                            {"kth", "threshold"},
                            {"sfl", "fatigue-limit"},
                            {"k", "shear-yield"},
                            {"ps", "plane-stress"},
                            {"no-ps", "plane-strain"},
                            {"c", "criterion"},
                            {"rec", "records"},
                            {"j", "json"}});
   study.parse();
   require(!study.options().says("check"), "option --check: this run has no meshes to show");
   FrettingSettings criteria;
   criteria.criterion = criteria_by_name.at(criterion);
   study.results["criterion"] = criterion;
   FatigueMaterial &m = pad.material;
   const std::vector<FatigueMaterial> materials = read_materials(material_file);
   m = find_material(materials, material);
   const auto replace = [](double from, double scale, double &to)
   { to = std::isnan(from) ? to : from * scale; };
   replace(young, 1e3, m.young);
   replace(poisson, 1, m.poisson);
   replace(threshold, mpa_sqrt_m, m.threshold);
   if (!std::isnan(limit)) { m.fatigue_limit = {limit, limit}; }
   if (!std::isnan(yield)) { m.shear_yield = {yield, yield}; }
   m.validate();
   if (std::isnan(pad.friction))
   {
      require(m.friction.high > 0, "the material ", m.name,
              " has no friction coefficient; give one with --friction.");
      pad.friction = m.friction.middle();
   }

   require(std::isnan(depth) || pad.kind == "fe",
           "--averaging-depth is for the pad 'fe', whose stresses are known.");
   study.only_if(!std::isnan(depth), {"findley", "fatemi-socie"},
                 "goes with --averaging-depth");
   const PadContact closed_form = calibrate(pad);
   PadContact contact = closed_form;
   std::optional<SolvedPad> solved;
   if (pad.kind == "fe")
   {
      solved = solve(study, pad, contact, true);
      // Within a spacing of an edge the mesh resolves neither the tractions nor the peak of the
      // stress. Deeper than the half-width of the contact they have decayed.
      require(std::isnan(depth) || (depth >= solved->spacing && depth <= solved->half_width),
              "--averaging-depth is ", depth,
              " mm, must be from the spacing of the contact nodes, ", solved->spacing,
              " mm, to the half-width of the contact, ", solved->half_width,
              " mm; --nodes makes the spacing smaller.");
      compare(study, pad, contact, *solved);
      contact = solved->in_place_of(contact);
   }
   const JudgedEdge judged = judge(pad, contact, criteria);
   const SolvedPad *const known = solved ? &*solved : nullptr;
   print_page(study, pad, known, contact, judged, criteria);
   if (solved || pad.kind == "kn" || !study.keeps_panels() || has_closed_tractions(pad))
   {
      draw_tractions(study, pad, known);
   }
   else // no closed form: they are solved for, to be drawn
   {
      try
      {
         const SolvedPad drawn = solve(study, pad, closed_form, false);
         draw_tractions(study, pad, &drawn);
         study.say(
            "\n   Figures of pressure, shear and stress along the surface are of the contact "
            "as --pad fe solves it.");
      }
      catch (const InputError &error)
      {
         study.say(std::string("\n   No figure of the tractions: ") + error.what());
      }
   }
   if (solved)
   {
      print_solution(study, *solved);
      if (!std::isnan(depth))
      {
         judge_planes(study, pad, closed_form, *solved, depth, weights);
      }
   }
   draw_design(study, pad, judged, criteria);
   if (!records.empty()) { correlate(study, records, pad, criteria, materials); }
}

void fretting_study(Study &study)
{
   try
   {
      assess_pad(study);
   }
   catch (const PadSlides &slides)
   {
      study.results["status"] = name(FrictionStatus::gross_sliding);
      study.results["message"] = slides.what();
      study.say(std::string("Slides: ") + slides.what());
      throw Outcome();
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("fretting", argc, argv, fretting_study);
}
