#include <cattaneo/friction/contact_state_json.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/json_text.hpp>
#include <cattaneo/whole_file.hpp>

namespace nlohmann
{

/// A list of numbers.
template <>
struct adl_serializer<Eigen::VectorXd>
{
   static void to_json(json &j, const Eigen::VectorXd &x) { j = cattaneo::json_list(x); }
   static void from_json(const json &j, Eigen::VectorXd &x) { x = cattaneo::json_vector(j); }
};

} // namespace nlohmann

namespace cattaneo
{

static const char *const format_name = "cattaneo contact state 1";

template <class Json>
void to_json(Json &json, const Loop &loop)
{
   json = {static_cast<int>(loop.control_),
           loop.whole_,
           loop.work_,
           loop.least_.force,
           loop.most_.force,
           loop.last_.force,
           loop.least_.displacement,
           loop.most_.displacement,
           loop.last_.displacement};
}

template <class Json>
void from_json(const Json &json, Loop &loop)
{
   loop.control_ = json.at(0).template get<int>() == 0 ? Control::force : Control::displacement;
   json.at(1).get_to(loop.whole_);
   double *const numbers[] = {&loop.work_,
                              &loop.least_.force,
                              &loop.most_.force,
                              &loop.last_.force,
                              &loop.least_.displacement,
                              &loop.most_.displacement,
                              &loop.last_.displacement};
   for (std::size_t k = 0; k < std::size(numbers); ++k) { json.at(k + 2).get_to(*numbers[k]); }
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CycleRecord, cycle, whole, loops, dissipation, external_work,
                                   normal_work, slip_change, node_dissipation)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContactState, time, step, peak_force, dissipation,
                                   multipliers, status, cycle_slip, slip_origin, v, w, q, p)

std::vector<double> json_list(const Eigen::VectorXd &x)
{
   return {x.data(), x.data() + x.size()};
}

Eigen::VectorXd json_vector(const nlohmann::json &j)
{
   const auto values = j.get<std::vector<double>>();
   return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

nlohmann::json to_json(const ContactState &state)
{
   state.require_finite(); // otherwise it would be written as null
   nlohmann::json j = state;
   if (!state.loads.empty()) { j["loads"] = state.loads; }
   if (state.cycle) { j["cycle"] = *state.cycle; }
   if (!state.kept.empty()) { j["kept"] = state.kept; }
   j["format"] = format_name;
   return j;
}

ContactState contact_state(const nlohmann::json &j, const std::string &file)
{
   for (int s : j.at("status").get<std::vector<int>>())
   {
      require(s >= 0 && s <= 4, "contact state: status ", s, " in file '", file,
              "', must be 0 to 4");
   }
   auto state = j.get<ContactState>();
   if (j.contains("loads")) { j["loads"].get_to(state.loads); }
   if (j.contains("cycle")) { state.cycle = j["cycle"].get<CycleRecord>(); }
   if (j.contains("kept")) { j["kept"].get_to(state.kept); }
   return state;
}

void read_state_file(const std::string &what, const std::string &file,
                     const std::string &format,
                     const std::function<void(const nlohmann::json &)> &read)
{
   try
   {
      const nlohmann::json j =
         parsed(read_whole(file, what + ": "), what + ": file '" + file + "'");
      require(j.at("format") == format, what, ": file '", file, "' has format ",
              j.at("format").dump(), ", must be \"", format, "\"");
      read(j);
   }
   catch (const nlohmann::json::exception &e)
   {
      constexpr int no_such_key = 403; // named between quotes
      const std::string said = e.what();
      const std::size_t from = std::min(said.find('\''), said.size()),
                        to = std::min(said.rfind('\''), said.size());
      constexpr int no_json = 101;
      const std::string must = ", must be a file that a march has saved";
      throw InputError(what + ": file '" + file + "' is not a " + what + ": " +
                       (e.id == no_such_key
                           ? "it lacks the key " + said.substr(from, to - from) + "'" + must
                        : e.id == no_json ? "it is not JSON" + must
                                          : said.substr(said.find("] ") + 2)));
   }
}

void save(const ContactState &state, const std::string &file)
{
   write_whole(file, to_json(state).dump(1) + '\n');
}

ContactState load_contact_state(const std::string &file)
{
   ContactState state;
   read_state_file("contact state", file, format_name,
                   [&](const nlohmann::json &j) { state = contact_state(j, file); });
   return state;
}

} // namespace cattaneo
