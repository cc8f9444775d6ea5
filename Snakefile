include: "workflow/rules/common.smk"
include: "workflow/rules/geometry.smk"
include: "workflow/rules/mesh.smk"
include: "workflow/rules/compliance.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/strength.smk"
include: "workflow/rules/stiffness.smk"
include: "workflow/rules/modal.smk"
include: "workflow/rules/dynamics.smk"
include: "validation/rules/dynamics.smk"
include: "workflow/rules/branches.smk"
include: "validation/rules/mesh.smk"
include: "validation/rules/contact.smk"
include: "validation/rules/strength.smk"
include: "workflow/rules/load_sharing.smk"
include: "workflow/rules/contact_studies.smk"
include: "workflow/rules/tolerances.smk"
include: "workflow/rules/search.smk"
include: "validation/rules/scenarios.smk"
include: "paper/rules/scorecard.smk"
include: "workflow/rules/report.smk"
include: "validation/rules/targets.smk"
include: "workflow/rules/defaults.smk"


rule all:
    default_target: True
    input:
        targets(CASE),
        rules.report.output.html.format(case=CASE),


localrules:
    all,
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
    report,
