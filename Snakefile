include: "workflow/rules/common.smk"
include: "workflow/rules/stages.smk"
include: "validation/rules/dynamics.smk"
include: "validation/rules/mesh.smk"
include: "validation/rules/contact.smk"
include: "validation/rules/strength.smk"
include: "validation/rules/scenarios.smk"
include: "validation/rules/growth.smk"
include: "paper/rules/scorecard.smk"
include: "paper/rules/figures.smk"
include: "workflow/rules/report.smk"
include: "validation/rules/targets.smk"
include: "workflow/rules/defaults.smk"


rule all:
    default_target: True
    input:
        targets(CASE),
        rules.report.output.html.format(case=CASE),
    localrule: True
