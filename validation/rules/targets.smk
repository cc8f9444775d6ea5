rule benchmarks:
    "Speed against error of all that is measured."
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
                "growth",
                *(["scenarios"] if CASES[CASE]["tolerances"] else []),
            ],
        ),
    localrule: True


rule peers:
    "The same quantities by other programs."
    input:
        expand(
            f"results/{CASE}/benchmarks/{{name}}.csv",
            name=[
                "calculix",
                "calculix_stress",
                "calculix_body",
                "cyclic_teeth",
                "kratos_hertz",
                "pair_peer",
                "family_peer",
                "shaft_peer",
            ],
        ),
    localrule: True
