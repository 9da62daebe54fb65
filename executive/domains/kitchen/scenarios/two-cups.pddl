; Two cups that stand beside each other, to another table, and back: 13 actions.
(define (problem two-cups)
  (:domain kitchen)
  (:objects dock left1 right1 left2 right2 home - place cup1 cup2 - cup)
  (:init (robot-at dock) (cup-at cup1 left1) (cup-at cup2 right1) (hand-empty) (arm-home) (free left2) (free right2))
  (:goal (and (cup-at cup1 left2) (cup-at cup2 right2) (robot-at home))))
