include: "workflow/rules/common.smk"
include: "workflow/rules/geometry.smk"
include: "workflow/rules/mesh.smk"
include: "workflow/rules/compliance.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/stiffness.smk"
include: "workflow/rules/modal.smk"
include: "workflow/rules/dynamics.smk"
include: "workflow/rules/dynamics_benchmarks.smk"
include: "workflow/rules/contact_benchmarks.smk"
include: "workflow/rules/load_sharing.smk"
include: "workflow/rules/scorecard.smk"
include: "workflow/rules/identify.smk"
include: "workflow/rules/functions/targets.smk"
include: "workflow/rules/report.smk"


rule all:
    default_target: True
    input:
        targets(CASE),
        f"results/{CASE}/report.html",


rule benchmarks:
    input:
        f"results/{CASE}/benchmarks/mesh.csv",
        contact_benchmark_targets(CASE),
        dynamics_benchmark_targets(CASE),
