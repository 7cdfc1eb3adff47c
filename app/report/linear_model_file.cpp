#include "app/report/linear_model_file.hpp"

#include "app/report/npz_archive.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace flyball {
namespace {

using Matrix = Eigen::MatrixXd;
using OrderedJson = nlohmann::ordered_json;

OrderedJson finite_json(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson matrix_json(const Matrix& m) {
  OrderedJson rows = OrderedJson::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    rows.push_back(OrderedJson::array());
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      rows.back().push_back(m(i, j));
  }
  return rows;
}

OrderedJson complex_json(const std::vector<std::complex<double>>& values) {
  OrderedJson out = OrderedJson::array();
  for (const auto& value : values)
    out.push_back({value.real(), value.imag()});
  return out;
}

OrderedJson signal_json(const LinearSignal& signal) {
  return {{"name", signal.name}, {"unit", signal.unit}, {"value", finite_json(signal.value)}};
}

// Zeros of every output by every input; null where there is no transfer at all, or none without E.
OrderedJson zeros_json(const LinearModel& model) {
  OrderedJson out = OrderedJson::object();
  for (std::size_t i = 0; i < model.outputs.size(); ++i)
    for (std::size_t j = 0; j < model.inputs.size(); ++j) {
      OrderedJson& entry = out[model.outputs[i].name][model.inputs[j].name];
      entry = nullptr;
      if (!model.explicit_form) continue;
      if (const auto found =
              zeros(*model.explicit_form, static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)))
        entry = complex_json(*found);
    }
  return out;
}

std::string script_matrix(const Matrix& m, bool python) {
  std::string out = "[";
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    out += i == 0 ? "" : python ? ",\n     " : ";\n     ";
    if (python) out += "[";
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      out += fmt::format("{}{}", j == 0 ? "" : ", ", m(i, j));
    if (python) out += "]";
  }
  return out + "]";
}

// A text in a script: in single quotes that are doubled, or as JSON has it.
std::string script_text(std::string_view text, bool python) {
  if (python) return OrderedJson(std::string(text)).dump(-1, ' ', true);
  std::string out = "'";
  for (const char c : printable(text))
    out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

template <class Signals, class Part>
std::string script_texts(const Signals& signals, Part part, bool python) {
  std::string out = python ? "[" : "{";
  for (std::size_t i = 0; i < signals.size(); ++i)
    out += (i == 0 ? "" : ", ") + script_text(signals[i].*part, python);
  return out + (python ? "]" : "}");
}

template <class Signals>
Matrix values_of(const Signals& signals) {
  Matrix out(1, static_cast<Eigen::Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i)
    out(0, static_cast<Eigen::Index>(i)) = signals[i].value;
  return out;
}

// A matrix without rows or columns has no brackets that tell its size.
std::string sized(const Matrix& m, bool python) {
  if (m.size() > 0) return script_matrix(m, python);
  if (!python) return fmt::format("zeros({}, {})", m.rows(), m.cols());
  return fmt::format("[[] for _ in range({})]", m.rows());
}

// What both scripts have, a comment sign before what is told.
std::string script_head(const Mechanism& mechanism, const LinearModel& model, const char* sign) {
  std::string out =
      fmt::format("{0} {1}: linear model about the steady state, by flyball.\n{0} Small changes: ", sign,
                  printable(mechanism.name));
  out += model.explicit_form
             ? "x' = A x + B u, y = C x + D u.\n"
             : "E x' = A x + B u, y = C x + D u; E is singular, or nearly so: some bodies have no mass, or "
               "hardly any.\n";
  if (const std::string text = friction_text(model); !text.empty())
    out += fmt::format("{} {}\n", sign, printable(text));
  else if (has_friction(mechanism))
    out +=
        fmt::format("{} Of the motion once joints with dry friction slip: their hold is left out.\n", sign);
  for (const LinearModel::State& state : model.states)
    if (state.less_input)
      out += fmt::format("{} {}: less what the inputs give it at once (the rows of B above).\n", sign,
                         printable(state.name));
  return out;
}

std::string matlab_file(const Mechanism& mechanism, const LinearModel& model) {
  const StateSpace& x = best_form(model);
  std::string out = script_head(mechanism, model, "%");
  const auto put = [&](const char* name, const std::string& value) {
    out += fmt::format("{} = {};\n", name, value);
  };
  if (x.e.size() > 0) put("E", sized(x.e, false));
  put("A", sized(x.a, false));
  put("B", sized(x.b, false));
  put("C", sized(x.c, false));
  put("D", sized(x.d, false));
  const auto names = [&](const char* what, const auto& signals) {
    const std::string w = what;
    put((w + "_names").c_str(), script_texts(signals, &LinearSignal::name, false));
    put((w + "_units").c_str(), script_texts(signals, &LinearSignal::unit, false));
    put((w + "_values").c_str(), sized(values_of(signals), false)); // in the steady state
  };
  names("state", model.states);
  names("input", model.inputs);
  names("output", model.outputs);
  const char* make = x.e.size() > 0 ? "dss(A, B, C, D, E)" : "ss(A, B, C, D)";
  out += fmt::format("if exist('{}')\n  model = {};\n", x.e.size() > 0 ? "dss" : "ss", make);
  out += "  model.StateName = state_names;\n  model.InputName = input_names;\n  model.OutputName = "
         "output_names;\nend\n";
  return out;
}

std::string python_file(const Mechanism& mechanism, const LinearModel& model) {
  const StateSpace& x = best_form(model);
  std::string out = script_head(mechanism, model, "#");
  const auto put = [&](const char* name, const std::string& value) {
    out += fmt::format("{} = {}\n", name, value);
  };
  if (x.e.size() > 0)
    put("E", sized(x.e, true));
  else
    out += "E = None  # the identity\n";
  put("A", sized(x.a, true));
  put("B", sized(x.b, true));
  put("C", sized(x.c, true));
  put("D", sized(x.d, true));
  const auto names = [&](const char* what, const auto& signals) {
    const std::string w = what;
    put((w + "_names").c_str(), script_texts(signals, &LinearSignal::name, true));
    put((w + "_units").c_str(), script_texts(signals, &LinearSignal::unit, true));
    const Matrix values = values_of(signals);
    put((w + "_values").c_str(),
        values.size() > 0 ? script_matrix(values, true).substr(1, script_matrix(values, true).size() - 2)
                          : "[]"); // in the steady state
  };
  names("state", model.states);
  names("input", model.inputs);
  names("output", model.outputs);
  out += R"(
system = None  # of python-control, where it is installed
try:
    import numpy as np
    A, B, C, D = (np.array(m, dtype=float).reshape(shape) for m, shape in (
        (A, (len(state_names), len(state_names))), (B, (len(state_names), len(input_names))),
        (C, (len(output_names), len(state_names))), (D, (len(output_names), len(input_names)))))
    if E is not None:
        E = np.array(E, dtype=float)
    else:
        import control
        states, inputs, outputs = ([name.replace(".", "/") for name in names]  # it takes no dots
                                   for names in (state_names, input_names, output_names))
        system = control.ss(A, B, C, D, states=states, inputs=inputs, outputs=outputs)
except ImportError:
    pass

if __name__ == "__main__":
    print(system if system is not None else {"A": A, "B": B, "C": C, "D": D, "E": E})
)";
  return out;
}

NpzArray npz_matrix(const char* name, const Matrix& m) {
  NpzArray out{name, "<f8", fmt::format("{}, {}", m.rows(), m.cols()), {}};
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      out.items.append(reinterpret_cast<const char*>(&m(i, j)), sizeof(double));
  return out;
}

// Of valid UTF-8.
std::u32string code_points(std::string_view text) {
  std::u32string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0xC0)
      out.push_back(byte & (byte >= 0xF0 ? 0x07u : byte >= 0xE0 ? 0x0Fu : 0x1Fu));
    else if (byte >= 0x80)
      out.back() = out.back() << 6 | (byte & 0x3Fu);
    else
      out.push_back(byte);
  }
  return out;
}

// Texts as NumPy's, of the longest's size.
template <class Signals, class Part>
NpzArray npz_texts(const std::string& name, const Signals& signals, Part part) {
  std::vector<std::u32string> texts;
  std::size_t longest = 1;
  for (const auto& signal : signals) {
    texts.push_back(code_points(signal.*part));
    longest = std::max(longest, texts.back().size());
  }
  NpzArray out{name, fmt::format("<U{}", longest), fmt::format("{},", signals.size()), {}};
  for (std::u32string& text : texts) {
    text.resize(longest, U'\0');
    out.items.append(reinterpret_cast<const char*>(text.data()), longest * sizeof(char32_t));
  }
  return out;
}

std::string npz_file(const LinearModel& model) {
  const StateSpace& x = best_form(model);
  std::vector<NpzArray> arrays{npz_matrix("A", x.a), npz_matrix("B", x.b), npz_matrix("C", x.c),
                               npz_matrix("D", x.d)};
  if (x.e.size() > 0) arrays.push_back(npz_matrix("E", x.e));
  const auto names = [&](const std::string& what, const auto& signals) {
    arrays.push_back(npz_texts(what + "_names", signals, &LinearSignal::name));
    arrays.push_back(npz_texts(what + "_units", signals, &LinearSignal::unit));
    NpzArray values = npz_matrix((what + "_values").c_str(), values_of(signals));
    values.shape = fmt::format("{},", signals.size());
    arrays.push_back(std::move(values));
  };
  names("state", model.states);
  names("input", model.inputs);
  names("output", model.outputs);
  return npz_archive(arrays);
}

} // namespace

std::optional<LinearModelFormat> linear_model_format(std::string_view extension) {
  if (extension == ".json") return LinearModelFormat::json;
  if (extension == ".npz") return LinearModelFormat::npz;
  if (extension == ".m") return LinearModelFormat::matlab;
  if (extension == ".py") return LinearModelFormat::python;
  return {};
}

std::string friction_text(const LinearModel& model) {
  const auto list = [](const std::vector<std::string>& names) {
    return word_list(std::vector<std::string_view>(names.begin(), names.end()), "and");
  };
  std::string out;
  if (!model.held.empty()) out = "Linear model with " + list(model.held) + " held by dry friction.";
  if (!model.slipping.empty())
    out += (out.empty() ? "" : " ") + list(model.slipping) +
           (model.slipping.size() > 1 ? " slip" : " slips") + " on, against constant friction.";
  return out;
}

OrderedJson linear_model_json(const Mechanism& mechanism, const LinearModel& model) {
  OrderedJson out;
  out["name"] = mechanism.name;
  const bool any = model.refusal.empty();
  out["message"] = any ? model.explicit_form ? "x' = A x + B u, y = C x + D u."
                                             : "Bodies without mass, or with hardly any, follow the others "
                                               "at once: E x' = A x + B u alone."
                       : model.refusal;
  if (const std::string text = friction_text(model); any && !text.empty())
    out["message"] = out["message"].get<std::string>() + " " + text;
  for (const char* key : {"states", "inputs", "outputs", "A", "B", "C", "D", "descriptor", "poles", "zeros",
                          "static_gain", "stable", "residual", "run_time_s"})
    out[key] = nullptr;
  if (has_friction(mechanism))
    for (const char* key : {"held_by_friction", "slips"})
      out[key] = nullptr;
  if (!any) return out;
  if (has_friction(mechanism)) {
    out["held_by_friction"] = model.held;
    out["slips"] = model.slipping;
  }
  const auto list = [&](const char* key, const auto& signals) {
    out[key] = OrderedJson::array();
    for (const auto& signal : signals)
      out[key].push_back(signal_json(signal));
  };
  list("states", model.states);
  for (std::size_t i = 0; i < model.states.size(); ++i)
    out["states"][i]["less_input"] = model.states[i].less_input;
  list("inputs", model.inputs);
  list("outputs", model.outputs);
  for (std::size_t i = 0; i < model.outputs.size(); ++i)
    out["outputs"][i]["relative_error"] = finite_json(model.output_error[static_cast<Eigen::Index>(i)]);
  if (const auto& x = model.explicit_form) {
    out["A"] = matrix_json(x->a);
    out["B"] = matrix_json(x->b);
    out["C"] = matrix_json(x->c);
    out["D"] = matrix_json(x->d);
  }
  const StateSpace& x = model.descriptor;
  out["descriptor"] = {{"E", matrix_json(x.e)},
                       {"A", matrix_json(x.a)},
                       {"B", matrix_json(x.b)},
                       {"C", matrix_json(x.c)},
                       {"D", matrix_json(x.d)}};
  out["poles"] = complex_json(model.poles);
  out["zeros"] = zeros_json(model);
  if (model.gain) out["static_gain"] = matrix_json(*model.gain);
  if (model.stable) out["stable"] = *model.stable;
  out["residual"] = finite_json(model.steady.residual);
  out["run_time_s"] = model.steady.run_time_s + model.run_time_s;
  return out;
}

std::string linear_model_file(const Mechanism& mechanism, const LinearModel& model,
                              LinearModelFormat format) {
  switch (format) {
  case LinearModelFormat::npz: return npz_file(model);
  case LinearModelFormat::matlab: return matlab_file(mechanism, model);
  case LinearModelFormat::python: return python_file(mechanism, model);
  case LinearModelFormat::json: break;
  }
  return linear_model_json(mechanism, model).dump(2) + "\n";
}

std::string bode_csv(const LinearModel& model, const std::vector<double>& frequencies) {
  const auto curves = frequency_response(model, frequencies);
  std::string out = "frequency (Hz)";
  for (const LinearSignal& output : model.outputs)
    for (const LinearSignal& input : model.inputs) {
      const std::string pair = output.name + " by " + input.name;
      const std::string unit = transfer_unit(output, input);
      out += "," + csv_field(pair + (unit.empty() ? "" : " (" + unit + ")"));
      out += "," + csv_field(pair + ", phase (deg)");
    }
  out += "\r\n";
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    out += csv_number(frequencies[k]);
    for (const std::vector<BodePoint>& curve : curves)
      out += "," + csv_number(curve[k].magnitude) + "," + csv_number(curve[k].phase);
    out += "\r\n";
  }
  return out;
}

} // namespace flyball
