include: "workflow/rules/common.smk"
include: "workflow/rules/geometry.smk"
include: "workflow/rules/mesh.smk"
include: "workflow/rules/compliance.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/strength.smk"
include: "workflow/rules/stiffness.smk"
include: "workflow/rules/modal.smk"
include: "workflow/rules/dynamics.smk"
include: "workflow/rules/dynamics_benchmarks.smk"
include: "workflow/rules/branches.smk"
include: "workflow/rules/contact_benchmarks.smk"
include: "workflow/rules/strength_benchmarks.smk"
include: "workflow/rules/load_sharing.smk"
include: "workflow/rules/contact_studies.smk"
include: "workflow/rules/tolerances.smk"
include: "workflow/rules/search.smk"
include: "workflow/rules/scenarios_benchmarks.smk"
include: "workflow/rules/scorecard.smk"
include: "workflow/rules/identify.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/defaults.smk"


rule all:
    default_target: True
    input:
        targets(CASE),
        rules.report.output.html.format(case=CASE),


rule benchmarks:
    input:
        expand(
            "results/{case}/benchmarks/{name}.csv",
            case=CASE,
            name=[
                "mesh",
                "contact",
                "contact_shortcuts",
                "strength",
                "twin",
                "dynamics",
                "dynamics_sweep",
                "dynamics_convergence",
                "dynamics_labels",
                "load_sharing_costs",
                "branches",
                *(["scenarios"] if CASES[CASE]["tolerances"] else []),
            ],
        ),


rule peers:
    input:
        expand(f"results/{CASE}/benchmarks/{{name}}.csv", name=["calculix", "calculix_stress"]),


rule identify:
    input:
        expand(
            f"results/{CASE}/identify/{{name}}.csv",
            name=["load_estimates", "random", "accurate", "sets"] if IDENTIFY else [],
        ),


localrules:
    all,
    benchmarks,
    peers,
    identify,
    tooth_pair_figure,
    contact_figures,
    load_dependence,
    root_stress_figures,
    rating_figures,
    stiffness,
    stiffness_figures,
    load_dependence_figure,
    ratings,
    modal,
    modal_figure,
    dynamics_figures,
    branches_figures,
    load_sharing_summary,
    load_sharing_figures,
    contact_studies,
    contact_studies_figures,
    tolerances,
    tolerances_figures,
    tolerances_map_figure,
    search_figures,
    identify_load_estimates,
    identify_samples,
    identify_region,
    identify_all_runs,
    report,
