#include <algorithm>
#include <cattaneo/fretting/fatigue_material.hpp>
#include <cattaneo/fretting/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/json_text.hpp>
#include <cattaneo/whole_file.hpp>
#include <cctype>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

using nlohmann::json;

/// One record, with its place in the file for messages.
struct Record
{
   const json &data;
   std::string where;

   const json &at(const char *key) const
   {
      require(data.contains(key), where, " has no \"", key, "\".");
      return data.at(key);
   }
   double number(const json &value, const char *key) const
   {
      require(value.is_number(), where, ": \"", key, "\" is ", value.dump(),
              "; it must be a number.");
      return value.get<double>();
   }
   double number(const char *key) const { return number(at(key), key); }
   Interval interval(const char *key) const
   {
      const json &value = at(key);
      if (!value.is_array())
      {
         const double exact = number(value, key);
         return {exact, exact};
      }
      require(value.size() == 2, where, ": \"", key, "\" is ", value.dump(),
              "; it must be a number or [low, high].");
      return {number(value[0], key), number(value[1], key)};
   }
   Basis basis(const char *key) const
   {
      const json value = data.value(key, json("range"));
      require(value == "range" || value == "amplitude", where, ": \"", key, "\" is ",
              value.dump(), "; it must be \"range\" or \"amplitude\".");
      return value == "range" ? Basis::range : Basis::amplitude;
   }
};

std::string lower_case(std::string text)
{
   std::transform(text.begin(), text.end(), text.begin(),
                  [](unsigned char c) { return char(std::tolower(c)); });
   return text;
}

void require_interval(const std::string &name, const char *what, const Interval &value)
{
   require(std::isfinite(value.high) && value.low > 0 && value.low <= value.high, "material ",
           name, ": ", what, " is ", value.low,
           value.low == value.high ? "" : " to " + exact_text(value.high),
           "; it must be positive, the low end first.");
}

} // namespace

void FatigueMaterial::validate() const
{
   require(std::isfinite(young) && young > 0, "material ", name, ": Young's modulus is ", young,
           " MPa; it must be positive.");
   out_of_plane_constraint(poisson, false);
   require(std::isfinite(threshold) && threshold > 0, "material ", name, ": ΔK_th is ",
           threshold, " MPa√mm; it must be positive.");
   require_interval(name, "the fatigue limit", fatigue_limit);
   require_interval(name, "the shear yield stress", shear_yield);
   if (friction.high != 0) { require_interval(name, "the friction coefficient", friction); }
   require(threshold_ratio >= -1 && threshold_ratio < 1, "material ", name,
           ": the load ratio of the threshold is ", threshold_ratio,
           "; it must be at least -1 and below 1.");
   require(threshold_basis == fatigue_limit_basis, "material ", name, ": ΔK_th is given as ",
           threshold_basis == Basis::range ? "a range" : "an amplitude",
           " but the fatigue limit as ",
           fatigue_limit_basis == Basis::range ? "a range" : "an amplitude",
           "; give both as ranges or both as amplitudes.");
}

double critical_length(const FatigueMaterial &material)
{
   material.validate();
   return std::pow(material.threshold / material.fatigue_limit.low, 2) / M_PI;
}

std::vector<FatigueMaterial> read_materials(const std::string &file)
{
   json document;
   try
   {
      document = parsed(read_whole(file, "material file: "), "material file '" + file + "'");
   }
   catch (const json::exception &)
   {
      document = nullptr; // which the next check refuses
   }
   require(document.is_object() && document.contains("materials") &&
              document["materials"].is_array() && !document["materials"].empty(),
           "the material file ", file,
           " must be JSON with a list \"materials\" of at least one record.");
   std::vector<FatigueMaterial> materials;
   for (const json &data : document["materials"])
   {
      Record record{data, file + ", record " + std::to_string(materials.size() + 1)};
      require(data.is_object(), record.where, " must be an object.");
      const json &name = record.at("name");
      require(name.is_string(), record.where, ": \"name\" must be a text.");
      record.where += " (" + name.get<std::string>() + ")";
      FatigueMaterial m;
      m.name = name.get<std::string>();
      m.young = 1000 * record.number("young_GPa");
      m.poisson = record.number("poisson");
      m.threshold = mpa_sqrt_m * record.number("threshold_MPa_sqrt_m");
      m.fatigue_limit = record.interval("fatigue_limit_MPa");
      m.shear_yield = record.interval("shear_yield_MPa");
      if (data.contains("friction")) { m.friction = record.interval("friction"); }
      if (data.contains("stress_ratio")) { m.threshold_ratio = record.number("stress_ratio"); }
      m.threshold_basis = record.basis("threshold_basis");
      m.fatigue_limit_basis = record.basis("fatigue_limit_basis");
      m.validate();
      materials.push_back(m);
   }
   return materials;
}

const FatigueMaterial &find_material(const std::vector<FatigueMaterial> &materials,
                                     const std::string &name)
{
   std::string names;
   for (const FatigueMaterial &material : materials)
   {
      if (lower_case(material.name) == lower_case(name)) { return material; }
      names += (names.empty() ? "" : ", ") + material.name;
   }
   throw InputError("there is no material '" + name + "'; there are: " + names + ".");
}

} // namespace cattaneo::fretting
