#include "FrettingSettings.hpp"
#include "PlaneWeights.hpp"
#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <functional>
#include <sstream>

// Near-edge fields, closed forms and criteria of fretting. Functions of numbers take arrays
// too, entry by entry, as NumPy's do.

namespace cattaneo::python
{

namespace
{

using namespace fretting;

CATTANEO_ARGUMENT(Entries, "float | numpy.typing.NDArray[numpy.float64]", anything);

using Names = std::vector<const char *>;

/// f for each entry of the arguments, which are broadcast; a float if all are numbers. If f
/// gives several values (`columns`), these are the last dimension of the result.
nb::object each_entry(const std::vector<nb::object> &arguments, const Names &names,
                      std::size_t columns,
                      const std::function<void(const double *, double *)> &f)
{
   const nb::module_ numpy = nb::module_::import_("numpy");
   nb::list all;
   for (std::size_t k = 0; k < arguments.size(); ++k)
   {
      const nb::object &argument = arguments[k];
      if (PyFloat_CheckExact(argument.ptr()) || PyLong_CheckExact(argument.ptr()))
      {
         all.append(numpy.attr("float64")(number(argument, names[k])));
         continue;
      }
      // Checked as one row, so that the error names the entry.
      const nb::object shape = numpy.attr("shape")(argument);
      const nb::object flat = nb::len(shape) == 0 ? argument : numpy.attr("ravel")(argument);
      const Eigen::VectorXd values = nb::len(shape) == 0
                                        ? Eigen::VectorXd::Constant(1, number(flat, names[k]))
                                        : vector(flat, names[k]);
      all.append(array(values).attr("reshape")(shape));
   }
   nb::object same;
   try
   {
      same = numpy.attr("broadcast_arrays")(*nb::tuple(all));
   }
   catch (nb::python_error &error)
   {
      if (!error.matches(PyExc_ValueError)) { throw; }
      throw InputError(std::string("shapes of ") + names.front() + " to " + names.back() +
                       " do not fit each other, must broadcast");
   }
   const nb::object shape = same[0].attr("shape");
   const nb::object rows = numpy.attr("stack")(same, nb::arg("axis") = -1); // (…, arguments)
   const Eigen::MatrixXd table =
      matrix(rows.attr("reshape")(-1, static_cast<Index>(arguments.size())), "arguments");
   Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> result(
      table.rows(), static_cast<Index>(columns));
   for (Index i = 0; i < table.rows(); ++i)
   {
      const Eigen::RowVectorXd row = table.row(i);
      f(row.data(), result.row(i).data());
   }
   if (nb::len(shape) == 0 && columns == 1) { return nb::cast(result(0, 0)); }
   nb::list sizes;
   for (const nb::handle size : shape) { sizes.append(size); }
   if (columns > 1) { sizes.append(columns); }
   return array(std::move(result)).attr("reshape")(nb::tuple(sizes));
}

template <class>
using AnyNumbers = Numbers;

template <class... Each, std::size_t... I>
void define(nb::module_ &m, const char *name, double (*f)(Each...),
            const std::array<const char *, sizeof...(Each)> &names, const char *doc,
            std::index_sequence<I...>)
{
   m.def(
      name,
      [f, names](AnyNumbers<Each>... values)
      {
         return nb::borrow<Entries>(
            each_entry({values...}, Names(names.begin(), names.end()), 1,
                       [f](const double *x, double *y) { *y = f(x[I]...); }));
      },
      arg(names[I])..., doc);
}
/// Binds a function of numbers.
template <class... Each>
void define(nb::module_ &m, const char *name, double (*f)(Each...),
            const std::array<const char *, sizeof...(Each)> &names, const char *doc)
{
   define(m, name, f, names, doc, std::index_sequence_for<Each...>());
}

template <class... Each, std::size_t... I>
void define_of_edge(nb::module_ &m, const char *name, double (*f)(const Edge &, Each...),
                    const std::array<const char *, sizeof...(Each)> &names, const char *doc,
                    std::index_sequence<I...>)
{
   m.def(
      name,
      [f, names](const Edge &edge, AnyNumbers<Each>... values)
      {
         return nb::borrow<Entries>(
            each_entry({values...}, Names(names.begin(), names.end()), 1,
                       [f, edge](const double *x, double *y) { *y = f(edge, x[I]...); }));
      },
      arg("edge"), arg(names[I])..., doc);
}
/// Binds a function of an edge and numbers.
template <class... Each>
void define_of_edge(nb::module_ &m, const char *name, double (*f)(const Edge &, Each...),
                    const std::array<const char *, sizeof...(Each)> &names, const char *doc)
{
   define_of_edge(m, name, f, names, doc, std::index_sequence_for<Each...>());
}

void bind_near_edge(nb::module_ &m)
{
   nb::class_<Edge>(
      m, "Edge",
      "The edge of a contact at one instant. At the distance t from the edge the pressure is p "
      "= k_n √t, and the shear would be q = k_t/√t if nothing had slipped. Any consistent "
      "units; with N and mm k_n is in MPa/√mm, k_t in MPa√mm.")
      .def(
         "__init__",
         [](Edge *self, double k_n, double k_t, double friction)
         {
            const Edge edge{finite(k_n, "k_n"), finite(k_t, "k_t"),
                            finite(friction, "friction")};
            edge.validate();
            new (self) Edge(edge);
         },
         arg("k_n"), arg("k_t"), arg("friction"))
      .def_ro("k_n", &Edge::k_n)
      .def_ro("k_t", &Edge::k_t)
      .def_ro("friction", &Edge::friction)
      .def("__repr__",
           [](const Edge &self)
           {
              return "Edge(k_n=" + exact_text(self.k_n) + ", k_t=" + exact_text(self.k_t) +
                     ", friction=" + exact_text(self.friction) + ")";
           });
   m.def(
      "slip_zone", [](const Edge &edge) { return slip_zone(edge); }, arg("edge"),
      "2 |K_T|/(f K_N)");
   m.def(
      "edge_stress", [](const Edge &edge) { return edge_stress(edge); }, arg("edge"),
      "Stress σ_xx along the surface at the contact edge, tension positive.");
   define_of_edge(
      m, "pressure", &pressure, {"t"},
      "Pressure at the distance t from the edge, compression positive; 0 outside the contact.");
   define_of_edge(m, "shear_traction", &shear_traction, {"t"},
                  "Shear traction at the distance t from the edge under partial slip.");
   m.def(
      "stress",
      [](const Edge &edge, Numbers t, Numbers y)
      {
         return nb::borrow<Reals>(each_entry({t, y}, {"t", "y"}, 3,
                                             [&](const double *x, double *s)
                                             {
                                                const InPlaneStress at =
                                                   stress(edge, x[0], x[1]);
                                                s[0] = at.xx;
                                                s[1] = at.yy;
                                                s[2] = at.xy;
                                             }));
      },
      arg("edge"), arg("t"), arg("y"),
      "Stresses xx, yy and xy in the near-edge field at (t, y), y >= 0 the depth, tension "
      "positive.");
   define_of_edge(m, "reversed_slip_zone", &reversed_slip_zone, {"k_t_range"}, "ΔK_T/(f K_N)");
   define_of_edge(
      m, "edge_stress_range", &edge_stress_range, {"k_t_range"},
      "Range of σ_xx at the contact edge over a cycle in which K_T changes by k_t_range.");
   define(m, "mode_two_range", &mode_two_range, {"k_t_range"}, "√(2π) ΔK_T");
   define_of_edge(m, "slip_energy_density", &slip_energy_density, {"k_t_range", "modulus", "t"},
                  "Energy lost by friction per area and cycle at the distance t from the edge. "
                  "modulus: E*.");
   define(m, "slip_energy_max", &slip_energy_max, {"k_t_range", "modulus"}, "√3 ΔK_T²/E*");
   define_of_edge(m, "slip_energy_total", &slip_energy_total, {"k_t_range", "modulus"},
                  "Energy lost by friction per cycle, edge and unit thickness. modulus: E*.");
   define(m, "hertz_slip_energy", &hertz_slip_energy,
          {"friction", "load", "load_ratio", "modulus"},
          "Energy lost by friction per cycle and unit thickness of a Hertz contact under ±Q. "
          "load_ratio: Q/fP, 0 to 1. modulus: E*.");
   define(m, "crack_factor", &crack_factor, {"ratio"},
          "κ(c/d) of the shear part of the near-edge field, K_I = 2 K_T κ(c/d). ratio: crack "
          "depth over slip zone, at least 0.");
   define(
      m, "power_law_factor", &power_law_factor, {"exponent"},
      "h(λ) of an edge crack under the stress (y/c)^λ, K_I = σ0 √(πc) h(λ). exponent: λ > -1.");
   define_of_edge(
      m, "crack_intensity", &crack_intensity, {"depth"},
      "K_I of a crack of a depth at the contact edge; negative if it is pressed shut.");
   define_of_edge(m, "crack_intensity_range", &crack_intensity_range, {"k_t_range", "depth"},
                  "Range of K_I of a crack of a depth in the steady cycle in which K_T changes "
                  "by k_t_range.");
}

void bind_calibration(nb::module_ &m)
{
   define(m, "hertz_k_n", &hertz_k_n, {"load", "half_width"},
          "K_N of a Hertz contact of a half-width.");
   define(m, "symmetric_k_n", &symmetric_k_n, {"half_width", "load_rate"},
          "K_N of any symmetric contact. load_rate: dP/da, growth of the load with the "
          "half-width.");
   define(m, "edge_gradient", &edge_gradient, {"radius", "modulus"}, "E*/R");
   m.def(
      "contact_modulus",
      [](double young, double poisson, bool plane_stress) {
         return contact_modulus(finite(young, "young"), finite(poisson, "poisson"),
                                plane_stress);
      },
      arg("young"), arg("poisson"), arg("plane_stress") = false,
      "E* of two bodies of one material: E/(2 (1 - ν²)) in plane strain, E/2 in plane stress.");

   nb::class_<HertzContact>(m, "HertzContact")
      .def_ro("half_width", &HertzContact::half_width)
      .def_ro("peak_pressure", &HertzContact::peak_pressure)
      .def_ro("k_n", &HertzContact::k_n)
      .def("__repr__",
           [](const HertzContact &self)
           {
              return "HertzContact(half_width=" + exact_text(self.half_width) +
                     ", peak_pressure=" + exact_text(self.peak_pressure) +
                     ", k_n=" + exact_text(self.k_n) + ")";
           });
   m.def(
      "hertz_contact",
      [](double load, double radius, double modulus)
      {
         return hertz_contact(finite(load, "load"), finite(radius, "radius"),
                              finite(modulus, "modulus"));
      },
      arg("load"), arg("radius"), arg("modulus"),
      "A Hertz contact. load: per unit thickness. radius: relative radius 1/(1/R1 + 1/R2). "
      "modulus: E*.");
   nb::class_<FlatRoundedContact>(m, "FlatRoundedContact")
      .def_ro("half_width", &FlatRoundedContact::half_width)
      .def_ro("k_n", &FlatRoundedContact::k_n)
      .def(
         "pressure",
         [](const FlatRoundedContact &self, Numbers x)
         {
            return nb::borrow<Entries>(each_entry(
               {x}, {"x"}, 1, [&](const double *at, double *p) { *p = self.pressure(*at); }));
         },
         arg("x"), "Pressure at the distance x from the centre; 0 outside the contact.");
   m.def(
      "flat_rounded_contact",
      [](double load, double radius, double flat, double modulus)
      {
         return flat_rounded_contact(finite(load, "load"), finite(radius, "radius"),
                                     finite(flat, "flat"), finite(modulus, "modulus"));
      },
      arg("load"), arg("radius"), arg("flat"), arg("modulus"),
      "A pad with a flat of half-width `flat` and rounded edges.");
   m.def(
      "shear_intensities",
      [](double half_width, double shear, double bulk_difference)
      {
         const ShearIntensities k =
            shear_intensities(finite(half_width, "half_width"), finite(shear, "shear"),
                              finite(bulk_difference, "bulk_difference"));
         return std::pair(k.trailing, k.leading);
      },
      arg("half_width"), arg("shear"), arg("bulk_difference") = 0.0,
      "K_T of the trailing and of the leading edge. shear: force on the cracked body per unit "
      "thickness. bulk_difference: tension in the cracked body less that in the other one.");
   m.def(
      "hertz_stress",
      [](double friction, double load_ratio, Numbers x, Numbers y)
      {
         const double f = finite(friction, "friction"),
                      ratio = finite(load_ratio, "load_ratio");
         return nb::borrow<Reals>(each_entry({x, y}, {"x", "y"}, 3,
                                             [&](const double *at, double *s)
                                             {
                                                const InPlaneStress stress =
                                                   hertz_stress(f, ratio, at[0], at[1]);
                                                s[0] = stress.xx;
                                                s[1] = stress.yy;
                                                s[2] = stress.xy;
                                             }));
      },
      arg("friction"), arg("load_ratio"), arg("x"), arg("y"),
      "Stresses xx, yy, xy at (x, y), y >= 0 the depth, under a Hertz contact in partial slip, "
      "in units of p0 and a, tension positive.");
   define(m, "first_yield_load", &first_yield_load, {"friction", "constraint"},
          "K_N √d over the yield stress in shear at first yield of the slip zone. constraint: "
          "Poisson's ratio in plane strain, 0 in plane stress.");
   define(m, "full_yield_load", &full_yield_load, {"friction"},
          "K_N √d over the yield stress in shear when the whole slip zone yields.");
   m.def(
      "out_of_plane_constraint",
      [](double poisson, bool plane_stress)
      { return out_of_plane_constraint(finite(poisson, "poisson"), plane_stress); },
      arg("poisson"), arg("plane_stress") = false);
}

void bind_corner(nb::module_ &m)
{
   nb::class_<CornerMode>(m, "CornerMode",
                          "One of Williams' eigensolutions of a bonded corner.")
      .def_ro("eigenvalue", &CornerMode::eigenvalue, "singular below 1")
      .def_ro("pressure", &CornerMode::pressure)
      .def_ro("shear", &CornerMode::shear)
      .def_prop_ro("traction_ratio", &CornerMode::traction_ratio)
      .def("__repr__", [](const CornerMode &self)
           { return "<CornerMode: eigenvalue " + exact_text(self.eigenvalue) + ">"; });
   nb::class_<CornerModes>(m, "CornerModes")
      .def_ro("one", &CornerModes::one)
      .def_prop_ro(
         "two", [](const CornerModes &self) { return self.two; },
         "None if there is no second one");
   m.def(
      "corner_modes",
      [](double pad_angle, double body_angle)
      {
         return corner_modes(
            Corner{finite(pad_angle, "pad_angle"), finite(body_angle, "body_angle")});
      },
      arg("pad_angle"), arg("body_angle"),
      "Modes at the corner of a pad on a body of the same material. pad_angle, body_angle: "
      "angles that they fill at the corner, in radians, with a sum above π and at most 2π.");
   m.def(
      "rigid_corner_modes",
      [](double pad_angle, double poisson, bool plane_stress)
      {
         return corner_modes(RigidCorner{finite(pad_angle, "pad_angle"),
                                         finite(poisson, "poisson"), plane_stress});
      },
      arg("pad_angle"), arg("poisson"), arg("plane_stress") = false,
      "Modes at the corner of an elastic pad on a rigid body.");
   nb::class_<CornerFit>(m, "CornerFit")
      .def_ro("k_one", &CornerFit::k_one)
      .def_ro("k_two", &CornerFit::k_two)
      .def_ro("modes", &CornerFit::modes)
      .def_ro("least_friction", &CornerFit::least_friction);
   m.def(
      "fit_corner",
      [](const CornerModes &modes, const EdgeTractions &tractions)
      { return fit_corner(modes, tractions); },
      arg("modes"), arg("tractions"));
}

void bind_criteria(nb::module_ &m)
{
   using Self = FatigueMaterial;
   nb::class_<Self>(m, "FatigueMaterial",
                    "Properties of a material for the criteria, in N, mm, MPa.")
      .def_ro("name", &Self::name)
      .def_ro("young", &Self::young)
      .def_ro("poisson", &Self::poisson)
      .def_ro("threshold", &Self::threshold, "ΔK_th, MPa√mm")
      .def_prop_ro("fatigue_limit", [](const Self &self)
                   { return std::pair(self.fatigue_limit.low, self.fatigue_limit.high); })
      .def_prop_ro("critical_length", &critical_length, "a0, mm")
      .def("__repr__",
           [](const Self &self) { return "<FatigueMaterial '" + self.name + "'>"; });
   m.def(
      "read_materials", [](File name) { return read_materials(file(name)); }, arg("file"));
   m.def(
      "find_material",
      [](File materials, const std::string &name)
      { return find_material(read_materials(file(materials, "materials")), name); },
      arg("materials"), arg("name"),
      "Finds a record by its name. materials: file of records (JSON); None: the file of the "
      "package.");

   m.def(
      "critical_plane",
      [](const std::string &criterion, const Self &material, Numbers cycle,
         PlaneWeights weights, const nb::kwargs &members)
      {
         set_members(weights, members);
         const CriticalPlane plane =
            critical_plane(chosen<PlaneCriterion>(criterion, "criterion"),
                           matrix(cycle, "cycle", -1, 4), material, weights);
         return std::pair(plane.value, plane.angle);
      },
      arg("criterion"), arg("material"), arg("cycle"), nb::kw_only(),
      arg("weights") = PlaneWeights(), arg("members"),
      "Largest value of 'findley', 'smith_watson_topper' or 'fatemi_socie' over the planes "
      "through a point, and the angle of that plane's normal from x. cycle: a row an instant, "
      "columns σ_xx, σ_yy, σ_zz, τ_xy in MPa.");
   m.def(
      "plain_fatigue_cycle",
      [](const Self &material)
      { return array(Eigen::MatrixXd(plain_fatigue_cycle(material))); },
      arg("material"),
      "The cycle of uniaxial stress that a plain specimen of a material just endures, for "
      "critical_plane().");

   nb::class_<FrettingReport> report(m, "FrettingReport",
                                     "Results of the criteria for an edge.");
   report.def_ro("k_t_range", &FrettingReport::k_t_range)
      .def_ro("slip_zone", &FrettingReport::slip_zone)
      .def_ro("edge_stress", &FrettingReport::edge_stress)
      .def_ro("edge_stress_range", &FrettingReport::edge_stress_range)
      .def_ro("yield_ratio_first", &FrettingReport::yield_ratio_first)
      .def_ro("yield_ratio_full", &FrettingReport::yield_ratio_full)
      .def_ro("critical_length", &FrettingReport::critical_length)
      .def_ro("k_i_max", &FrettingReport::k_i_max)
      .def_ro("k_i_min", &FrettingReport::k_i_min)
      .def_ro("abscissa", &FrettingReport::abscissa)
      .def_ro("ordinate", &FrettingReport::ordinate)
      .def_ro("threshold_ordinate", &FrettingReport::threshold_ordinate)
      .def_prop_ro("verdict",
                   [](const FrettingReport &self) { return to_string(self.threshold.verdict); })
      .def_prop_ro("arrest_depth",
                   [](const FrettingReport &self) { return self.threshold.arrest_depth; })
      .def_ro("mode_two_range", &FrettingReport::mode_two_range)
      .def_ro("mode_two_utilisation", &FrettingReport::mode_two_utilisation)
      .def_ro("energy_max", &FrettingReport::energy_max)
      .def_ro("energy_total", &FrettingReport::energy_total)
      .def_prop_ro("trust", [](const FrettingReport &self) { return to_string(self.trust); })
      .def_prop_ro("validity", each_of(&FrettingReport::validity, [](const Validity &each)
                                       { return std::pair(to_string(each.trust), each.text); }))
      .def("__repr__",
           [](const FrettingReport &self)
           {
              std::ostringstream text;

              text << "<FrettingReport: crack " << to_string(self.threshold.verdict)
                   << ", slip zone " << self.slip_zone << " mm, edge stress range "
                   << self.edge_stress_range << " MPa, trust " << to_string(self.trust) << ">";
              return text.str();
           });
   m.def(
      "assess",
      [](const Edge &edge, const Self &material, double stress_ratio,
         std::optional<double> bulk_stress, double stress_gradient, bool plane_stress,
         double half_width, double rounded_width, FrettingSettings settings,
         const nb::kwargs &members)
      {
         set_members(settings, members);
         FrettingProblem problem;
         problem.crack = {edge, finite(stress_ratio, "stress_ratio"),
                          finite(bulk_stress.value_or(0), "bulk_stress"),
                          finite(stress_gradient, "stress_gradient")};
         problem.material = material;
         problem.plane_stress = plane_stress;
         problem.half_width = finite(half_width, "half_width");
         problem.rounded_width = finite(rounded_width, "rounded_width");
         problem.bulk_known = bulk_stress.has_value();
         return assess(problem, settings);
      },
      arg("edge"), arg("material"), nb::kw_only(), arg("stress_ratio") = -1.0,
      arg("bulk_stress") = nb::none(), arg("stress_gradient") = 0.0,
      arg("plane_stress") = false, arg("half_width") = 0.0, arg("rounded_width") = 0.0,
      arg("settings") = FrettingSettings(), arg("members"),
      "Applies the fretting criteria to a contact edge at peak load, in N, mm, MPa.");
   m.def(
      "threshold_ordinate",
      [](const std::string &criterion, double friction, double abscissa, double stress_ratio)
      {
         return threshold_ordinate(chosen<Criterion>(criterion, "criterion"),
                                   finite(friction, "friction"), finite(abscissa, "abscissa"),
                                   finite(stress_ratio, "stress_ratio"));
      },
      arg("criterion"), arg("friction"), arg("abscissa"), arg("stress_ratio") = -1.0);
}

} // namespace

void bind_fretting(nb::module_ &m)
{
   nb::module_ of = m.def_submodule("fretting", "Near-edge fields and criteria of fretting.");
   bind_settings<FrettingSettings>(of);
   bind_settings<PlaneWeights>(of);
   bind_near_edge(of);
   bind_calibration(of);
   bind_corner(of);
   bind_criteria(of);
}

} // namespace cattaneo::python
